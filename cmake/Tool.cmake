# Each tool has a manual page, which tools/man-page.sh makes by help2man, and a completion for bash.
#
# sparselens_tool(NAME LIBRARY COMPONENT): the tool NAME, from NAME.cpp, of what it shares with others, and the component it
# is installed with.
# sparselens_tool_page(NAME PROGRAM COMPONENT): the page and the completion of the tool that the target NAME makes.
find_program(HELP2MAN help2man)
if(NOT HELP2MAN)
    message(STATUS "help2man is not installed, so the tools have no manual pages")
endif()

function(sparselens_tool_page name program component)
    set(pages ${CMAKE_BINARY_DIR}/share/man/man1)
    set(make_page ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../tools/man-page.sh)
    if(HELP2MAN)
        file(MAKE_DIRECTORY ${pages})
        add_custom_command(TARGET ${name} POST_BUILD COMMAND ${make_page} ${program} > ${pages}/${name}.1 VERBATIM)
        set_property(TARGET ${name} APPEND PROPERTY LINK_DEPENDS ${make_page})
    endif()
    install(FILES ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../tools/completion.sh DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${name} COMPONENT ${component})
    if(HELP2MAN)
        install(FILES ${pages}/${name}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
    endif()
endfunction()

function(sparselens_tool name library component)
    add_executable(${name} ${name}.cpp $<$<PLATFORM_ID:Windows>:${CMAKE_CURRENT_FUNCTION_LIST_DIR}/windows.rc>)
    target_link_libraries(${name} PRIVATE ${library} sparselens_flags sparselens_cold)
    sparselens_tool_page(${name} $<TARGET_FILE:${name}> ${component})
    install(TARGETS ${name} COMPONENT ${component})
endfunction()
