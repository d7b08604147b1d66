# dof-view is built where cpp-httplib is there.
pkg_check_modules(httplib QUIET IMPORTED_TARGET cpp-httplib)
sparselens_found_option(SPARSELENS_VIEW "Build dof-view (needs cpp-httplib)" ${httplib_FOUND}
    "dof-view" "cpp-httplib (Debian: libcpp-httplib-dev)")
if(SPARSELENS_VIEW AND NOT httplib_FOUND)
    message(FATAL_ERROR "SPARSELENS_VIEW needs cpp-httplib (Debian: libcpp-httplib-dev), which was not found. Install it, or "
        "configure with -DSPARSELENS_VIEW=OFF.")
endif()
