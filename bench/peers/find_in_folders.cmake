# Peers that no package of the distribution brings: found in folders that the user names.

# Header-only libraries that a user has, in one folder: sets found_NAME and the library
# boxwood_NAME_headers for each of them.
set(BOXWOOD_PEER_PATH "" CACHE PATH "Folder of header-only peers or of their checkouts: tiny_bvh.h, bvh/v2/bvh.h")
if(BOXWOOD_PEER_PATH AND NOT IS_DIRECTORY "${BOXWOOD_PEER_PATH}")
    message(FATAL_ERROR "BOXWOOD_PEER_PATH is '${BOXWOOD_PEER_PATH}', which is no folder: name the one that holds "
                        "tiny_bvh.h or bvh/v2/bvh.h, or checkouts of tinybvh and bvh, or leave it empty")
endif()
# boxwood_header_peer(NAME HEADER)
function(boxwood_header_peer name header)
    set(found FALSE)
    unset(folder)
    if(BOXWOOD_PEER_PATH)
        find_path(folder ${header} PATHS ${BOXWOOD_PEER_PATH} PATH_SUFFIXES . tinybvh src bvh/src NO_DEFAULT_PATH NO_CACHE)
    endif()
    if(folder)
        set(found TRUE)
        add_library(boxwood_${name}_headers INTERFACE)
        target_include_directories(boxwood_${name}_headers SYSTEM INTERFACE ${folder})
    endif()
    set(found_${name} ${found} PARENT_SCOPE)
    set(${name}_why "no ${header} (-DBOXWOOD_PEER_PATH=FOLDER names where it lies)" PARENT_SCOPE)
endfunction()
boxwood_header_peer(tinybvh tiny_bvh.h)
boxwood_header_peer(madmann_bvh bvh/v2/bvh.h)

# Sets warp_folder to NVIDIA Warp's Python package, if it is there, and warp_why to why the peer warp
# is not built. The package that `scripts/setup --with-warp` puts into build/warp is used where the
# user names none.
set(BOXWOOD_WARP "" CACHE PATH "NVIDIA Warp: the folder warp/ of its Python package; found in build/warp where empty")
set(warp_folder ${BOXWOOD_WARP})
if(NOT warp_folder)
    file(GLOB warp_folder ${PROJECT_SOURCE_DIR}/build/warp/lib/python3*/site-packages/warp)
endif()
set(warp_why "")
if(BOXWOOD_WARP AND NOT EXISTS ${BOXWOOD_WARP}/native/bvh.h)
    message(FATAL_ERROR "BOXWOOD_WARP is '${BOXWOOD_WARP}', which has no native/bvh.h: name the folder warp/ of the "
                        "Python package warp-lang, or leave it empty")
elseif(NOT EXISTS "${warp_folder}/native/bvh.h" OR NOT EXISTS "${warp_folder}/bin/warp.so")
    set(warp_folder "")
    set(warp_why "package not found (scripts/setup --with-warp)")
elseif(NOT BOXWOOD_NVCC)
    set(warp_why "nvcc not found, which it needs")
endif()

# What the sources of the peer are compiled with, on a device or on the host.
add_library(boxwood_warp INTERFACE)
if(warp_folder)
    cmake_path(GET warp_folder PARENT_PATH warp_include)
    target_include_directories(boxwood_warp SYSTEM INTERFACE ${warp_include})
    target_compile_definitions(boxwood_warp INTERFACE BOXWOOD_WARP_LIBRARY="${warp_folder}/bin/warp.so")
    # Not boxwood_cuda_options: Warp's users have fused multiply-adds.
    target_compile_options(boxwood_warp INTERFACE
        "$<$<COMPILE_LANGUAGE:CUDA>:-std=c++20;-Werror=cross-execution-space-call>"
        "$<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Wall,-Wextra,-Wconversion,-Wshadow,-Wdouble-promotion>"
        "$<$<AND:$<BOOL:${BOXWOOD_WERROR}>,$<COMPILE_LANGUAGE:CUDA>>:-Werror=all-warnings>")
    target_link_libraries(boxwood_warp INTERFACE ${CMAKE_DL_LIBS})
endif()

# Coal is linked by a module that is opened when it is wanted.
include(${PROJECT_SOURCE_DIR}/trees/adapters/find_coal.cmake)
if(NOT coal_why)
    file(STRINGS ${coal_folder}/include/coal/config.hh coal_version REGEX "define COAL_VERSION ")
    string(REGEX REPLACE ".*\"(.*)\".*" "\\1" coal_version "${coal_version}")
    add_library(boxwood_coal MODULE peers/coal/module.cpp peers/coal/meshes.cpp peers/coal/shapes.cpp
                peers/coal/shape_replay.cpp peers/coal/robots.cpp)
    target_link_libraries(boxwood_coal PRIVATE boxwood_options boxwood_warnings boxwood_trees boxwood_coal_library)
    target_link_options(boxwood_coal PRIVATE -Wl,--no-undefined)
    if(NOT pybind11_FOUND) # for which they are it already
        boxwood_position_independent(kernels)
        boxwood_position_independent(trees)
    endif()
endif()
