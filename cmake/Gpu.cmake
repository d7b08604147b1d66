# The kernels for GPUs: Vulkan's headers (its loader is opened at run time, and only where a GPU is asked for), and a
# compiler and a validator of shaders.
find_path(VULKAN_HEADERS vulkan/vulkan_raii.hpp)
find_program(GLSLC glslc)
find_program(SPIRV_VAL spirv-val)
mark_as_advanced(VULKAN_HEADERS GLSLC SPIRV_VAL)
if(VULKAN_HEADERS AND GLSLC AND SPIRV_VAL)
    set(gpu_found ON)
else()
    set(gpu_found OFF)
endif()
sparselens_found_option(SPARSELENS_GPU "Build the kernels for GPUs (needs the headers of Vulkan, glslc and spirv-val)" ${gpu_found}
    "the kernels for GPUs (--device gpu)" "headers of Vulkan, glslc or spirv-val (Debian: libvulkan-dev, glslc, spirv-tools)")

# The headers of src/kernels as GLSL: `#include "kernels/NAME.h"` in shaders.
function(sparselens_kernel_headers)
    foreach(header IN LISTS ARGN)
        set(made ${CMAKE_CURRENT_BINARY_DIR}/glsl/${header})
        add_custom_command(OUTPUT ${made}
            COMMAND ${CMAKE_COMMAND} -DFROM=${CMAKE_CURRENT_SOURCE_DIR}/${header} -DTO=${made} -P ${PROJECT_SOURCE_DIR}/cmake/AsGlsl.cmake
            DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${header} ${PROJECT_SOURCE_DIR}/cmake/AsGlsl.cmake VERBATIM)
        list(APPEND all ${made})
    endforeach()
    set(kernel_headers ${all} PARENT_SCOPE)
endfunction()

# sparselens_shader(SOURCE SHADER INCLUDED...): SHADER, a path below the current folder, is compiled and validated before
# SOURCE, which includes its words as NAME.inc; it includes the other files.
function(sparselens_shader source shader)
    cmake_path(GET shader FILENAME name)
    set(from ${CMAKE_CURRENT_SOURCE_DIR}/${shader})
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/shaders)
    set(made ${folder}/${name})
    file(MAKE_DIRECTORY ${folder})
    add_custom_command(OUTPUT ${made}.inc
        COMMAND ${GLSLC} --target-env=vulkan1.2 -O -Werror -I ${CMAKE_CURRENT_BINARY_DIR}/glsl ${from} -o ${made}.spv
        COMMAND ${SPIRV_VAL} --target-env vulkan1.2 ${made}.spv
        COMMAND ${GLSLC} --target-env=vulkan1.2 -O -Werror -I ${CMAKE_CURRENT_BINARY_DIR}/glsl -mfmt=num ${from} -o ${made}.inc
        DEPENDS ${from} ${ARGN} ${kernel_headers} VERBATIM)
    set_property(SOURCE ${source} APPEND PROPERTY OBJECT_DEPENDS ${made}.inc)
    set_property(SOURCE ${source} APPEND PROPERTY INCLUDE_DIRECTORIES ${folder})
endfunction()
