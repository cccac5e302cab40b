# Included by CMake after the project's own project() line.
if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
    # All symbols are looked up when a module is loaded, so that a missing one shows at the import and not in the middle of work.
    string(APPEND CMAKE_MODULE_LINKER_FLAGS
        " -Wl,-z,now -Wl,--version-script=${CMAKE_CURRENT_LIST_DIR}/exported_symbols.map")
elseif(APPLE)
    # LLVM's linker makes a signed bundle that exports its entry point alone. zig's own leaves the C++ library's names to whoever
    # else has them in the process, and Blender has.
    set(CMAKE_CXX_CREATE_SHARED_MODULE
        "$ENV{SKINGLOW_LLD} -arch ${CMAKE_SYSTEM_PROCESSOR} -platform_version macos 11.0 11.0 -bundle -adhoc_codesign -o <TARGET> <OBJECTS> \
<LINK_LIBRARIES> $ENV{SKINGLOW_MACOS_LIBRARIES} -undefined dynamic_lookup -exported_symbol '_PyInit_*' -dead_strip -x")
elseif(WIN32)
    # With LLVM's C++ library pybind11 exports its exceptions, and with them what they call.
    add_compile_definitions(PYBIND11_EXPORT_EXCEPTION=)
endif()
# The licenses of what is compiled in go into the wheel.
install(DIRECTORY ${SKINGLOW_PARTS}/licenses/ DESTINATION ${SKBUILD_METADATA_DIR}/licenses/third_party COMPONENT python)
install(FILES ${SKINGLOW_PARTS}/skinglow.cdx.json DESTINATION ${SKBUILD_METADATA_DIR}/sboms COMPONENT python)
# pybind11 shares its tables of types between modules that it takes for compatible: our two share them, since _rays takes lights of
# _core, and no module of another origin, with another C++ library, does. Of exceptions _rays has its own translator
# (python_bindings/rays_module.cpp).
add_compile_definitions(PYBIND11_BUILD_ABI="_skinglow")
