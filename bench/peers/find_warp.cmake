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
