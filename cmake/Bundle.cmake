# libpng and libjpeg read PNG and JPEG (Debian: libpng-dev, libjpeg-dev). The small module of tools/bundle.sh has nothing
# else, because the archive does not carry OpenImageIO.
pkg_check_modules(Libpng REQUIRED QUIET IMPORTED_TARGET libpng)
pkg_check_modules(Libjpeg REQUIRED QUIET IMPORTED_TARGET libjpeg)
option(SPARSELENS_BUNDLE "Build the small module of tools/bundle.sh" ON)
