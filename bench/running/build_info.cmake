# Makes build_info.h (versions, flags, CMake cache) when configuring and git_commit.h at every build;
# both are read by environment.cpp alone.
find_package(Eigen3 QUIET) # FCL's; nothing of ours uses it
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/build_info.h CONTENT
"// Made by bench/running/build_info.cmake.
#define BOXWOOD_VERSION \"${PROJECT_VERSION}\"
#define BOXWOOD_BUILD_TYPE \"${CMAKE_BUILD_TYPE}\"
#define BOXWOOD_SANITIZERS \"${BOXWOOD_SANITIZE}\"
#define BOXWOOD_CXX_FLAGS \"${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} $<JOIN:$<TARGET_PROPERTY:boxwood_options,INTERFACE_COMPILE_OPTIONS>, >\"
#define BOXWOOD_HDF5_VERSION \"${HDF5_VERSION}\"
#define BOXWOOD_GBENCH_VERSION \"${benchmark_VERSION}\"
#define BOXWOOD_ASSIMP_VERSION \"${assimp_VERSION}\"
#define BOXWOOD_XXHASH_VERSION \"${XXHASH_VERSION}\"
#define BOXWOOD_EIGEN_VERSION \"${Eigen3_VERSION}\"
" CONDITION $<COMPILE_LANGUAGE:CXX>) # nvcc has flags of its own

set(cache_text "")
get_cmake_property(cache_names CACHE_VARIABLES)
foreach(name IN LISTS cache_names)
    get_property(type CACHE ${name} PROPERTY TYPE)
    if(NOT type MATCHES "INTERNAL|STATIC")
        string(APPEND cache_text "${name}:${type}=$CACHE{${name}}\n")
    endif()
endforeach()
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/cmake_cache.h @ONLY CONTENT
"// Made by bench/running/build_info.cmake.
inline constexpr char cmake_cache[] = R\"cache(@cache_text@)cache\";
")

add_custom_target(boxwood_git_commit
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR}
            -DOUTPUT=${CMAKE_CURRENT_BINARY_DIR}/git_commit.h
            -P ${CMAKE_CURRENT_SOURCE_DIR}/running/git_commit.cmake
    BYPRODUCTS ${CMAKE_CURRENT_BINARY_DIR}/git_commit.h
    COMMENT "Reading the git commit")
