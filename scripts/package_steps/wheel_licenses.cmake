# Included by CMake after the project's own project() line: puts the licences of what is compiled in into the wheel.
install(DIRECTORY ${SKINGLOW_LICENSES}/ DESTINATION ${SKBUILD_METADATA_DIR}/licenses/third_party COMPONENT python)
