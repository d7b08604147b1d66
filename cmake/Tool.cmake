# Each tool prints its own manual page and completions, from the options it takes; they lie where man and the shells look.
#
# sparselens_tool(NAME LIBRARY [COMPONENT]): the tool NAME, from NAME.cpp, of what it shares with others; the component it is
# installed with, if it is.
function(sparselens_tool name library)
    set(man_pages man/man1)
    set(bash_completions bash-completion/completions)
    set(zsh_completions zsh/site-functions)
    set(fish_completions fish/vendor_completions.d)
    set(share ${CMAKE_BINARY_DIR}/share)
    file(MAKE_DIRECTORY ${share}/${man_pages} ${share}/${bash_completions} ${share}/${zsh_completions} ${share}/${fish_completions})
    add_executable(${name} ${name}.cpp)
    target_link_libraries(${name} PRIVATE ${library} sparselens_flags sparselens_cold)
    add_custom_command(TARGET ${name} POST_BUILD
        COMMAND ${name} --man > ${share}/${man_pages}/${name}.1
        COMMAND ${name} --completion bash > ${share}/${bash_completions}/${name}
        COMMAND ${name} --completion zsh > ${share}/${zsh_completions}/_${name}
        COMMAND ${name} --completion fish > ${share}/${fish_completions}/${name}.fish
        VERBATIM)
    if(ARGC EQUAL 2)
        return()
    endif()
    set(component ${ARGV2})
    install(TARGETS ${name} COMPONENT ${component})
    install(FILES ${share}/${man_pages}/${name}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
    install(FILES ${share}/${bash_completions}/${name} DESTINATION ${CMAKE_INSTALL_DATADIR}/${bash_completions} COMPONENT ${component})
    install(FILES ${share}/${zsh_completions}/_${name} DESTINATION ${CMAKE_INSTALL_DATADIR}/${zsh_completions} COMPONENT ${component})
    install(FILES ${share}/${fish_completions}/${name}.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/${fish_completions} COMPONENT ${component})
endfunction()
