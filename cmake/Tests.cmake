# How tests are declared, here and in the laboratory.

# A script that exits 77 has said what it lacks (skips.sh) and counts as skipped.
function(sparselens_script_test name)
    add_test(NAME ${name} COMMAND bash ${ARGN})
    set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77)
endfunction()

# sparselens_unit_tests(NAME EXECUTABLE SHARDS [TEST...]): in shards, as a process for each test would cost more than most
# tests. The test NAME.slow, labelled `slow`, runs each TEST (a pattern of GoogleTest's filters); the shards leave it out.
function(sparselens_unit_tests name executable shards)
    set(environment GTEST_TOTAL_SHARDS=${shards})
    if(ARGN)
        list(JOIN ARGN : slow)
        list(APPEND environment GTEST_FILTER=-${slow})
        add_test(NAME ${name}.slow COMMAND ${executable} --gtest_brief=1)
        set_tests_properties(${name}.slow PROPERTIES ENVIRONMENT "GTEST_FILTER=${slow}" LABELS slow)
    endif()
    foreach(shard RANGE 1 ${shards})
        math(EXPR index "${shard} - 1")
        add_test(NAME ${name}.${shard} COMMAND ${executable} --gtest_brief=1)
        set_tests_properties(${name}.${shard} PROPERTIES ENVIRONMENT "${environment};GTEST_SHARD_INDEX=${index}")
    endforeach()
endfunction()

# sparselens_use_traced(NAME...): these scripts use traced pictures (traced, tests/tools/check.sh), which are made before.
function(sparselens_use_traced)
    foreach(name IN LISTS ARGN)
        if(TEST ${name})
            set_tests_properties(${name} PROPERTIES FIXTURES_REQUIRED traced)
        endif()
    endforeach()
endfunction()

# sparselens_costs(NAME=SECONDS...): in a new folder ctest knows no times: the longest first, so that none is left to run
# alone. In CPU seconds.
function(sparselens_costs)
    foreach(pair IN LISTS ARGN)
        string(REPLACE "=" ";" pair ${pair})
        list(GET pair 0 name)
        list(GET pair 1 cost)
        if(TEST ${name})
            set_tests_properties(${name} PROPERTIES COST ${cost})
        endif()
    endforeach()
endfunction()

# sparselens_slow(NAME...): tests/run.sh runs these only with --slow or --all; continuous integration does.
function(sparselens_slow)
    foreach(name IN LISTS ARGN)
        if(TEST ${name})
            set_property(TEST ${name} APPEND PROPERTY LABELS slow)
        endif()
    endforeach()
endfunction()

# What most unit tests include, compiled once.
function(sparselens_precompiled_tests target)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <map>
        <memory> <numeric> <optional> <random> <span> <sstream> <string> <vector> <ImathVec.h> <gtest/gtest.h>)
    # Sanitizers more than double what optimising takes; what is tested is optimised all the same.
    if(SPARSELENS_SANITIZE)
        target_compile_options(${target} PRIVATE -O0)
    endif()
    # In precompiled headers GCC 12 sees overflows of std::string that are not there.
    target_compile_options(${target} PRIVATE
        $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds> $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow>)
endfunction()
