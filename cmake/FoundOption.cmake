# sparselens_found_option(NAME HELP FOUND WHAT NEEDED): the option NAME, ON where what it needs is found. What was left out
# because it was not there is taken in when it has come; ON and OFF that somebody asked for stay. WHAT is what the option
# builds, and NEEDED what may be missing, both for sparselens_say_left_out(). An error where NAME is on all the same.
function(sparselens_found_option name help found what needed)
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
    if(NOT ${name} AND ${name}_LEFT_OUT)
        set_property(GLOBAL APPEND PROPERTY SPARSELENS_LEFT_OUT "Left out: ${what}. Missing: ${needed}")
    endif()
    if(${name} AND NOT found)
        message(FATAL_ERROR "${name} is on, but something is missing: ${needed}. Install it, or configure with -D${name}=OFF.")
    endif()
endfunction()

# The last lines of configuring: what was left out because something is missing, and what to install.
function(sparselens_say_left_out)
    get_property(lines GLOBAL PROPERTY SPARSELENS_LEFT_OUT)
    foreach(line IN LISTS lines)
        message(NOTICE "${line}")
    endforeach()
endfunction()
