# GLM by itself: Debian's configuration names /usr/include, whose C library headers are too new for a portable build.
# The folder `include` beside this file holds a link to GLM's headers.
if(NOT TARGET glm::glm)
    add_library(glm::glm INTERFACE IMPORTED)
    set_target_properties(glm::glm PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${CMAKE_CURRENT_LIST_DIR}/include)
endif()
