# Flags of everything that is compiled here. Contraction is off so that a picture does not depend on whether
# the machine has fused multiply-add.
add_library(sparselens_flags INTERFACE)
target_compile_options(sparselens_flags INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wshadow -ffp-contract=off -fno-math-errno
    $<$<BOOL:${SPARSELENS_WERROR}>:-Werror>)
if(SPARSELENS_SANITIZE)
    target_compile_options(sparselens_flags INTERFACE -fsanitize=${SPARSELENS_SANITIZE} -fno-omit-frame-pointer -g)
    target_link_options(sparselens_flags INTERFACE -fsanitize=${SPARSELENS_SANITIZE})
endif()
