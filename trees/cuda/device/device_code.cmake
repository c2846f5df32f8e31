# What boxwood_trees has for devices: compiled by nvcc, or unavailable.cpp.
if(BOXWOOD_NVCC)
    target_sources(boxwood_trees PRIVATE
        cuda/device/graph.cu cuda/device/memory.cu cuda/device/rates.cu cuda/device/tree.cu cuda/device/triangles.cu
        cuda/device/machine.cpp cuda/device/machine.cu cuda/primitives.cu)
    target_link_libraries(boxwood_trees PRIVATE $<BUILD_INTERFACE:boxwood_cuda_options>)
    list(JOIN CMAKE_CUDA_ARCHITECTURES "," architectures)
    set_source_files_properties(cuda/device/machine.cu PROPERTIES
        COMPILE_DEFINITIONS "BOXWOOD_CUDA_ARCHITECTURES=\"${architectures}\"")
else()
    target_sources(boxwood_trees PRIVATE cuda/device/unavailable.cpp)
    set_source_files_properties(cuda/device/unavailable.cpp PROPERTIES
        COMPILE_DEFINITIONS "BOXWOOD_NO_NVCC=\"${BOXWOOD_NO_NVCC}\"")
endif()
