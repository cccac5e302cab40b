# CMake toolchain: zig's clang for Linux on arm64, all linked statically, so that programs run by qemu alone. Of what macOS' packages
# are made with on Apple's processors this has the compiler, its C++ library, Embree's and Highway's NEON. SKINGLOW_ZIG
# (environment): the zig program; SKINGLOW_BIN: its ar and ranlib.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR arm64)
set(CMAKE_C_COMPILER $ENV{SKINGLOW_ZIG} cc)
set(CMAKE_CXX_COMPILER $ENV{SKINGLOW_ZIG} c++)
set(CMAKE_C_COMPILER_TARGET aarch64-linux-musl)
set(CMAKE_CXX_COMPILER_TARGET aarch64-linux-musl)
set(CMAKE_C_FLAGS_INIT "-w -g0")
set(CMAKE_CXX_FLAGS_INIT "-w -g0")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_AR $ENV{SKINGLOW_BIN}/ar CACHE FILEPATH "")
set(CMAKE_RANLIB $ENV{SKINGLOW_BIN}/ranlib CACHE FILEPATH "")
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 CACHE STRING "")
