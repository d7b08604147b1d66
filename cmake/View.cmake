# dof-view is built where cpp-httplib is there.
pkg_check_modules(httplib QUIET IMPORTED_TARGET cpp-httplib)
sparselens_found_option(SPARSELENS_VIEW "Build dof-view (needs cpp-httplib)" ${httplib_FOUND}
    "dof-view" "cpp-httplib (Debian: libcpp-httplib-dev)")
