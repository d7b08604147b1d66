# What the library stands on.
find_package(Imath 3.1 CONFIG REQUIRED)
find_package(OpenEXR 3.1 CONFIG REQUIRED)
find_package(TBB CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
find_package(fmt 9.1 CONFIG REQUIRED)
find_package(nlohmann_json 3.11 CONFIG REQUIRED)
find_package(Threads REQUIRED)
# By pkg-config: what Debian has for CMake lies where CMake does not look, and names folders that do not exist.
find_package(PkgConfig REQUIRED)
pkg_check_modules(OpenColorIO REQUIRED IMPORTED_TARGET OpenColorIO>=2.1)

if(NOT WIN32) # there, the small module does without it
    find_package(OpenImageIO CONFIG REQUIRED) # its version file accepts no other major version than the one asked for
    if(OpenImageIO_VERSION VERSION_LESS 2.4)
        message(FATAL_ERROR "OpenImageIO ${OpenImageIO_VERSION} was found in ${OpenImageIO_DIR}; sparselens needs 2.4 or later")
    endif()
    # Debian's OpenImageIO target names OpenCV's headers, which its package does not bring and nobody here needs.
    get_target_property(oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
    list(FILTER oiio_includes EXCLUDE REGEX opencv)
    set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${oiio_includes}")
endif()
