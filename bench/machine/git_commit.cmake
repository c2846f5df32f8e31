# Writes OUTPUT with the commit of SOURCE and whether tracked files differ from it; run at every build
# and touched only when something changed. Without git, or outside a repository of its own (a
# tarball, perhaps unpacked inside another repository), the commit is "unknown".
set(commit "unknown")
set(dirty 0)
find_program(GIT git)
if(GIT)
    execute_process(COMMAND ${GIT} rev-parse --show-cdup HEAD WORKING_DIRECTORY ${SOURCE}
        OUTPUT_VARIABLE answer RESULT_VARIABLE failed ERROR_QUIET)
    # --show-cdup is an empty line at the top of a working tree, else the way up to it.
    if(NOT failed AND answer MATCHES "^\n([0-9a-f]+)\n$")
        set(commit "${CMAKE_MATCH_1}")
        # `scripts/reproduce all --publish` writes there between its sweeps, and no program reads it.
        execute_process(COMMAND ${GIT} status --porcelain --untracked-files=no -- . ":(exclude)results/published"
            WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE changes ERROR_QUIET)
        if(changes)
            set(dirty 1)
        endif()
    endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
"// Made by bench/machine/git_commit.cmake.
#define BOXWOOD_GIT_COMMIT \"${commit}\"
#define BOXWOOD_GIT_DIRTY ${dirty}
")
