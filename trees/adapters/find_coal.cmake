# Sets coal_folder to what holds Coal's include/ and lib/, if it is there, and coal_why to why it is not
# used. Defines the target boxwood_coal_library. The package that `scripts/setup --with-coal` puts into
# build/coal is used where the user names none.
set(BOXWOOD_COAL "" CACHE PATH "Coal: the folder of its include/ and lib/; found in build/coal where empty")
set(coal_folder ${BOXWOOD_COAL})
if(NOT coal_folder)
    file(GLOB coal_folder ${PROJECT_SOURCE_DIR}/build/coal/lib/python3*/site-packages/cmeel.prefix)
endif()
set(coal_why "")
if(BOXWOOD_COAL AND NOT EXISTS ${BOXWOOD_COAL}/include/coal/config.hh)
    message(FATAL_ERROR "BOXWOOD_COAL is '${BOXWOOD_COAL}', which has no include/coal/config.hh: name the folder "
                        "cmeel.prefix of the Python package libcoal, or leave it empty")
elseif(NOT EXISTS "${coal_folder}/include/coal/config.hh")
    set(coal_why "package not found (scripts/setup --with-coal)")
elseif(BOXWOOD_SANITIZE)
    set(coal_why "it is not made for sanitizers")
endif()
if(NOT coal_why AND NOT TARGET boxwood_coal_library)
    find_package(Eigen3 REQUIRED NO_MODULE)
    # Its CMake package would bring in another Boost and another assimp.
    add_library(boxwood_coal_library INTERFACE)
    target_include_directories(boxwood_coal_library SYSTEM INTERFACE ${coal_folder}/include)
    target_compile_definitions(boxwood_coal_library INTERFACE COAL_HAS_OCTOMAP COAL_HAVE_OCTOMAP
        OCTOMAP_MAJOR_VERSION=1 OCTOMAP_MINOR_VERSION=10 OCTOMAP_PATCH_VERSION=0)
    target_link_libraries(boxwood_coal_library INTERFACE Eigen3::Eigen ${coal_folder}/lib/libcoal.so)
    target_link_options(boxwood_coal_library INTERFACE -Wl,-rpath,${coal_folder}/lib)
endif()
