# CMake toolchain: zig's clang for Windows on x86-64, its C++ library linked in; of the system only the universal C runtime is
# needed, which Windows 10 and later bring. SKINGLOW_ZIG (environment): the zig program; SKINGLOW_BIN: its ar, ranlib and rc.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER $ENV{SKINGLOW_ZIG} cc)
set(CMAKE_CXX_COMPILER $ENV{SKINGLOW_ZIG} c++)
set(CMAKE_C_COMPILER_TARGET x86_64-windows-gnu)
set(CMAKE_CXX_COMPILER_TARGET x86_64-windows-gnu)
# As for Linux; the system's headers have M_PI for those who ask.
set(CMAKE_C_FLAGS_INIT "-mcpu=x86_64_v2 -w -g0 -D_USE_MATH_DEFINES")
set(CMAKE_CXX_FLAGS_INIT "-mcpu=x86_64_v2 -w -g0 -D_USE_MATH_DEFINES")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_AR $ENV{SKINGLOW_BIN}/ar CACHE FILEPATH "")
set(CMAKE_RANLIB $ENV{SKINGLOW_BIN}/ranlib CACHE FILEPATH "")
set(CMAKE_RC_COMPILER $ENV{SKINGLOW_BIN}/rc CACHE FILEPATH "")
# The machine's own, which knows no such modules.
set(CMAKE_STRIP "" CACHE FILEPATH "")
