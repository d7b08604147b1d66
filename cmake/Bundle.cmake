# The module that writes PNG, JPEG and TIFF in the archive of tools/bundle.sh, which does not carry OpenImageIO. It is
# built where its libraries are found (Debian: libpng-dev, libjpeg-dev, libtiff-dev).
pkg_check_modules(SmallFormats QUIET IMPORTED_TARGET libpng libjpeg libtiff-4>=4.5)
option(SPARSELENS_BUNDLE "Build the small module of tools/bundle.sh (needs libpng, libjpeg and libtiff 4.5)" ${SmallFormats_FOUND})
