# CMake toolchain: zig's clang, its own C++ library linked in, and the C library of 2018 to link against, so that the result
# runs on any x86-64 Linux with glibc 2.28 or later. SKINGLOW_ZIG (environment): the zig program.
set(CMAKE_C_COMPILER $ENV{SKINGLOW_ZIG} cc)
set(CMAKE_CXX_COMPILER $ENV{SKINGLOW_ZIG} c++)
# The C library and the processor are the oldest that Blender 4.2 and later run on.
set(CMAKE_C_COMPILER_TARGET x86_64-linux-gnu.2.28)
set(CMAKE_CXX_COMPILER_TARGET x86_64-linux-gnu.2.28)
# Warnings are the ordinary build's business, with the compilers that the project is written for; and zig would bring
# debugging information unasked.
set(CMAKE_C_FLAGS_INIT "-mcpu=x86_64_v2 -w -g0")
set(CMAKE_CXX_FLAGS_INIT "-mcpu=x86_64_v2 -w -g0")
# Only modules are linked: for a program, be it a test of CMake's, zig would compile its C++ library a second time.
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
