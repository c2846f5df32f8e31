# Sets BOXWOOD_NVCC to whether .cu files are compiled, by BOXWOOD_CUDA: AUTO with nvcc 12.2 or newer
# where one is found, ON or an error, OFF. If not, BOXWOOD_NO_NVCC says why not. The compiler that
# `scripts/setup --with-cuda` puts into build/cuda is used where the user names none.

set(BOXWOOD_NVCC FALSE)
set(BOXWOOD_NO_NVCC "BOXWOOD_CUDA is OFF")
if(NOT BOXWOOD_CUDA MATCHES "^(AUTO|ON|OFF)$")
    message(FATAL_ERROR "BOXWOOD_CUDA is '${BOXWOOD_CUDA}': give AUTO, ON or OFF")
endif()
if(NOT BOXWOOD_CUDA STREQUAL OFF)
    include(CheckLanguage)
    if(NOT CMAKE_CUDA_COMPILER)
        unset(CMAKE_CUDA_COMPILER CACHE) # it may be there since the last time
    endif()
    if(NOT CMAKE_CUDA_COMPILER AND NOT DEFINED ENV{CUDACXX})
        file(GLOB boxwood_own_nvcc ${PROJECT_SOURCE_DIR}/build/cuda/lib/python3*/site-packages/nvidia/cu13/bin/nvcc)
        if(boxwood_own_nvcc)
            set(CMAKE_CUDA_COMPILER "${boxwood_own_nvcc}" CACHE FILEPATH "nvcc, by scripts/setup --with-cuda")
        endif()
    endif()
    if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
        set(CMAKE_CUDA_ARCHITECTURES 80-real 90-real 90-virtual CACHE STRING "What the device code is compiled for")
    endif()
    check_language(CUDA)
    if(CMAKE_CUDA_COMPILER)
        enable_language(CUDA)
        if(CMAKE_CUDA_COMPILER_VERSION VERSION_LESS 12.2)
            set(BOXWOOD_NO_NVCC "${CMAKE_CUDA_COMPILER} is ${CMAKE_CUDA_COMPILER_VERSION}; C++20 needs 12.2 or newer")
        else()
            set(BOXWOOD_NVCC TRUE)
        endif()
    else()
        set(BOXWOOD_NO_NVCC "no nvcc was found (scripts/setup --with-cuda puts one into build/cuda)")
    endif()
    if(BOXWOOD_CUDA STREQUAL ON AND NOT BOXWOOD_NVCC)
        message(FATAL_ERROR "BOXWOOD_CUDA is ON, but ${BOXWOOD_NO_NVCC}. Name one by -DCMAKE_CUDA_COMPILER=PATH, "
                            "or leave BOXWOOD_CUDA at AUTO to build without device code.")
    endif()
endif()
file(WRITE ${PROJECT_BINARY_DIR}/nvcc_version.txt "${CMAKE_CUDA_COMPILER_VERSION}") # scripts/test reads it
if(NOT BOXWOOD_NVCC)
    file(WRITE ${PROJECT_BINARY_DIR}/nvcc_version.txt "")
    message(STATUS "CUDA: no device code is compiled: ${BOXWOOD_NO_NVCC}")
    return()
endif()

message(STATUS "CUDA: device code by nvcc ${CMAKE_CUDA_COMPILER_VERSION} for ${CMAKE_CUDA_ARCHITECTURES}")
set(CMAKE_CUDA_RUNTIME_LIBRARY Static)
# CMake 3.25 knows no C++20 of CUDA: not required it drops it, so it is named below.
set(CMAKE_CUDA_STANDARD 20)
set(CMAKE_CUDA_STANDARD_REQUIRED OFF)
# Without --expt-relaxed-constexpr, and
# with this error, no kernel can be compiled to nothing because it calls a function of the host.
add_library(boxwood_cuda_options INTERFACE)
target_compile_options(boxwood_cuda_options INTERFACE
    "$<$<COMPILE_LANGUAGE:CUDA>:-std=c++20;--fmad=false;-Werror=cross-execution-space-call>"
    "$<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Wall,-Wextra,-Wconversion,-Wshadow,-Wdouble-promotion,-ffp-contract=off>"
    "$<$<AND:$<BOOL:${BOXWOOD_WERROR}>,$<COMPILE_LANGUAGE:CUDA>>:-Werror=all-warnings>")
