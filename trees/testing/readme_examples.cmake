# The C++ examples of the top README.md, cut out of it so that the tests build and run what it shows.

# readme_example(FILE FIRST_LINE): the cpp block of README.md that begins so, written to FILE.
function(readme_example file first_line)
    file(READ ${PROJECT_SOURCE_DIR}/README.md text)
    string(FIND "${text}" "```cpp\n${first_line}\n" start)
    if(start EQUAL -1)
        message(FATAL_ERROR "README.md has no cpp block that begins with ${first_line}")
    endif()
    math(EXPR start "${start} + 7")
    string(SUBSTRING "${text}" ${start} -1 text)
    string(FIND "${text}" "```" end)
    string(SUBSTRING "${text}" 0 ${end} text)
    file(CONFIGURE OUTPUT ${file} CONTENT "${text}" @ONLY)
endfunction()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/README.md)

set(folder ${CMAKE_CURRENT_BINARY_DIR}/readme)
readme_example(${folder}/halving.cpp "#include \"trees/builder.h\"")
target_sources(boxwood_trees_test PRIVATE ${folder}/halving.cpp)

readme_example(${folder}/program.cpp "#include \"trees/trees.h\"")
add_executable(boxwood_readme_program ${folder}/program.cpp)
target_link_libraries(boxwood_readme_program PRIVATE boxwood_trees)
add_test(NAME Readme.TheProgramPrintsThePairs COMMAND boxwood_readme_program)
set_tests_properties(Readme.TheProgramPrintsThePairs PROPERTIES PASS_REGULAR_EXPRESSION "^0,1\n$")
