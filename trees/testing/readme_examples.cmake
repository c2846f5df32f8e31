# C++ examples of two READMEs, cut out of them so that the tests build and run what they show. (The first of README.md
# is trees/examples/pairs.cpp, which scripts/tests/test_install.py builds as a user does.)

# readme_example(FILE FIRST_LINE [README]): the cpp block of README.md, or of that one, that begins
# so, written to FILE.
function(readme_example file first_line)
    set(readme README.md ${ARGN})
    list(GET readme -1 readme)
    file(READ ${PROJECT_SOURCE_DIR}/${readme} text)
    string(FIND "${text}" "```cpp\n${first_line}\n" start)
    if(start EQUAL -1)
        message(FATAL_ERROR "${readme} has no cpp block that begins with ${first_line}")
    endif()
    math(EXPR start "${start} + 7")
    string(SUBSTRING "${text}" ${start} -1 text)
    string(FIND "${text}" "```" end)
    string(SUBSTRING "${text}" 0 ${end} text)
    file(CONFIGURE OUTPUT ${file} CONTENT "${text}" @ONLY)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${readme})
endfunction()

set(folder ${CMAKE_CURRENT_BINARY_DIR}/readme)
readme_example(${folder}/halving.cpp "#include \"trees/builder.h\"")
target_sources(boxwood_trees_test PRIVATE ${folder}/halving.cpp)

readme_example(${folder}/device.cpp "#include \"trees/device.h\"" trees/cuda/README.md)
add_executable(boxwood_device_program ${folder}/device.cpp)
target_link_libraries(boxwood_device_program PRIVATE boxwood_trees)
add_test(NAME Readme.TheProgramOfADevicePrintsThePairs COMMAND boxwood_device_program)
set_tests_properties(Readme.TheProgramOfADevicePrintsThePairs PROPERTIES PASS_REGULAR_EXPRESSION
                     "^0,1\n1 pair stays there; 1 in world 0, 0 in world 1\n$|^no device: .+\n$")
