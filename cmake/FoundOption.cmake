# sparselens_found_option(NAME HELP FOUND): the option NAME, ON where what it needs is found. What was left out because it
# was not there is taken in when it has come; ON and OFF that somebody asked for stay.
function(sparselens_found_option name help found)
    if(found AND NOT ${name} AND ${name}_LEFT_OUT)
        set(${name} ON CACHE BOOL "${help}" FORCE)
        message(STATUS "${name} is on now: what it needs has been found")
    elseif(NOT found AND NOT DEFINED ${name})
        set(${name}_LEFT_OUT TRUE CACHE INTERNAL "What ${name} needs was not found")
    endif()
    if(found)
        unset(${name}_LEFT_OUT CACHE)
    endif()
    option(${name} "${help}" ${found})
endfunction()
