# Makes build_info.h (versions, flags, CMake cache) when configuring and git_commit.h at every build;
# both are read by environment.cpp alone.
find_package(Eigen3 QUIET) # FCL's; nothing of ours uses it
# The Debian package of each library of environment.cpp, and what the options of each peer are.
set(debian_highway libhwy-dev)
set(debian_google-benchmark libbenchmark-dev)
set(debian_eigen libeigen3-dev)
set(debian_bullet libbullet-dev)
set(revisions "")
find_program(BOXWOOD_DPKG_QUERY dpkg-query)
mark_as_advanced(BOXWOOD_DPKG_QUERY)
foreach(library highway tbb eigen hdf5 google-benchmark assimp xxhash fmt cli11 tomlplusplus fcl embree cgal bullet boost nanoflann ode)
    if(NOT debian_${library})
        set(debian_${library} lib${library}-dev)
    endif()
    if(BOXWOOD_DPKG_QUERY)
        execute_process(COMMAND ${BOXWOOD_DPKG_QUERY} --show "--showformat=\${Version} " ${debian_${library}}
            OUTPUT_VARIABLE revision ERROR_QUIET)
        string(REGEX MATCH "^[^ ]+" revision "${revision}") # of the first of several architectures
        if(revision)
            string(APPEND revisions "{\"${library}\", \"${revision}\"},")
        endif()
    endif()
endforeach()
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
set(peer_flags "")
foreach(peer IN LISTS peers_found)
    set(options "$<FILTER:$<TARGET_PROPERTY:boxwood_peer_${peer},COMPILE_OPTIONS>,EXCLUDE,^-W>")
    string(APPEND peer_flags "{\"${peer}\", \"${CMAKE_CXX_FLAGS_${build_type}} $<JOIN:${options}, >\"},")
endforeach()
set(peers_unoptimised "")
if(NOT BOXWOOD_PEERS_OPTIMISE STREQUAL "-O3") # no such run is published
    set(peers_unoptimised " (peers ${BOXWOOD_PEERS_OPTIMISE})")
endif()
file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/build_info.h CONTENT
"// Made by bench/machine/build_info.cmake.
#define BOXWOOD_VERSION \"${PROJECT_VERSION}\"
#define BOXWOOD_BUILD_TYPE \"${CMAKE_BUILD_TYPE}\"
#define BOXWOOD_SANITIZERS \"${BOXWOOD_SANITIZE}\"
#define BOXWOOD_CXX_FLAGS \"${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} $<JOIN:$<TARGET_PROPERTY:boxwood_options,INTERFACE_COMPILE_OPTIONS>, > ${BOXWOOD_COPY_BY_COMPONENTS}${peers_unoptimised}\"
#define BOXWOOD_HDF5_VERSION \"${HDF5_VERSION}\"
#define BOXWOOD_GBENCH_VERSION \"${benchmark_VERSION}\"
#define BOXWOOD_ASSIMP_VERSION \"${assimp_VERSION}\"
#define BOXWOOD_XXHASH_VERSION \"${XXHASH_VERSION}\"
#define BOXWOOD_PACKAGE_REVISIONS ${revisions}
#define BOXWOOD_PEER_FLAGS ${peer_flags}
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
"// Made by bench/machine/build_info.cmake.
inline constexpr char cmake_cache[] = R\"cache(@cache_text@)cache\";
")

add_custom_target(boxwood_git_commit
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR}
            -DOUTPUT=${CMAKE_CURRENT_BINARY_DIR}/git_commit.h
            -P ${CMAKE_CURRENT_SOURCE_DIR}/machine/git_commit.cmake
    BYPRODUCTS ${CMAKE_CURRENT_BINARY_DIR}/git_commit.h
    COMMENT "Reading the git commit")
