// What the sanitizers are to know of the libraries under test; without sanitizers nobody asks.

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the sanitizer chose these names
extern "C" __attribute__((visibility("default"))) const char* __asan_default_options() {
    return "fast_unwind_on_malloc=0";  // or the stack of a leak ends in libstdc++ and nothing below can be
                                       // named
}

extern "C" __attribute__((visibility("default"))) const char* __lsan_default_suppressions() {
    // OpenImageIO 2.4 loses the text of its own error when libpng jumps out of a file that ends too early.
    return "leak:PNGInput::PngReadCallback\n";
}

extern "C" __attribute__((visibility("default"))) const char* __tsan_default_suppressions() {
    // Debian's Embree and TBB are not instrumented: the sanitizer cannot see how they synchronize.
    return "called_from_lib:libembree3.so\nrace:libembree3.so\nrace:libtbb.so\n";
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
