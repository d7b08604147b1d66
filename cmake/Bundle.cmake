# The module that writes PNG and reads PNG and JPEG in the archive of tools/bundle.sh, which does not carry OpenImageIO. It
# is built where libpng and libjpeg are found (Debian: libpng-dev, libjpeg-dev).
pkg_check_modules(Libpng QUIET IMPORTED_TARGET libpng)
pkg_check_modules(Libjpeg QUIET IMPORTED_TARGET libjpeg)
if(Libpng_FOUND AND Libjpeg_FOUND)
    set(small_module ON)
else()
    set(small_module OFF)
endif()
option(SPARSELENS_BUNDLE "Build the small module of tools/bundle.sh (needs libpng and libjpeg)" ${small_module})
