# Flags of everything that is compiled here. Contraction is off so that a picture does not depend on whether
# the machine has fused multiply-add. GCC 12's -Wrestrict finds what is not there in std::string (GCC bug 105651), GCC 14's
# -Wmaybe-uninitialized what is not there in std::optional, GCC 16's -Wdangling-pointer what is not there where one of two
# std::vector is chosen.
add_library(sparselens_flags INTERFACE)
target_compile_options(sparselens_flags INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wshadow -ffp-contract=off -fno-math-errno
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>:-Wno-maybe-uninitialized>
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,15>>:-Wno-dangling-pointer>
    $<$<BOOL:${SPARSELENS_WERROR}>:-Werror>)
if(SPARSELENS_SANITIZE)
    target_compile_options(sparselens_flags INTERFACE -fsanitize=${SPARSELENS_SANITIZE}
        -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
    target_link_options(sparselens_flags INTERFACE -fsanitize=${SPARSELENS_SANITIZE})
endif()

# Declaring options takes long to compile and no time to run, so it is compiled with less optimisation, which takes a
# third less time. Linked after sparselens_flags.
add_library(sparselens_cold INTERFACE)
target_compile_options(sparselens_cold INTERFACE $<$<CONFIG:Release>:-O1>)
