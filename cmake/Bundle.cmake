# The module that writes PNG in the archive of tools/bundle.sh, which does not carry OpenImageIO. It is built where libpng
# is found (Debian: libpng-dev).
pkg_check_modules(Libpng QUIET IMPORTED_TARGET libpng)
option(SPARSELENS_BUNDLE "Build the small module of tools/bundle.sh (needs libpng)" ${Libpng_FOUND})
