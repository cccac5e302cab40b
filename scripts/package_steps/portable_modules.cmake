# Included by CMake after the project's own project() line.
# All symbols are looked up when a module is loaded, so that a missing one shows at the import and not in the middle of work.
string(APPEND CMAKE_MODULE_LINKER_FLAGS
    " -Wl,-z,now -Wl,--version-script=${CMAKE_CURRENT_LIST_DIR}/exported_symbols.map")
# The licenses of what is compiled in go into the wheel.
install(DIRECTORY ${SKINGLOW_LICENSES}/ DESTINATION ${SKBUILD_METADATA_DIR}/licenses/third_party COMPONENT python)
# pybind11 shares its tables, those of exceptions among them, between modules that it takes for compatible. But these carry a
# C++ library each, and an exception of one has a type that the others do not know: no sharing, not even among our own.
add_compile_definitions(PYBIND11_BUILD_ABI="_skinglow_$<TARGET_PROPERTY:NAME>")
