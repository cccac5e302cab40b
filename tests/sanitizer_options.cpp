// What the sanitizers are to know of the libraries under test; without sanitizers nobody asks.

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the sanitizer chose these names
extern "C" __attribute__((visibility("default"))) const char* __tsan_default_suppressions() {
    // Debian's Embree and TBB are not instrumented: the sanitizer cannot see how they synchronize.
    return "called_from_lib:libembree3.so\nrace:libembree3.so\nrace:libtbb.so\n";
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
