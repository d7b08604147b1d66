# Debian packages, made by `cpack -G DEB` in the build folder: sparselens (the tools), sparselens-lab (the tools of the
# laboratory), libsparselens-dev (the library, headers, CMake files) and python3-sparselens (the Python module, where it is
# built). The package of the library is of a static one.
if(BUILD_SHARED_LIBS)
    return()
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The sparselens developers <sparselens@example.org>" CACHE STRING "Maintainer of the packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS # whatever the umask is
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/DebianFiles.cmake)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL tools dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME sparselens)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS python3) # for the scripts that submit to OpenCue and read USD
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS libvulkan1) # for GPUs: opened by name where one is asked for
set(CPACK_COMPONENT_TOOLS_DESCRIPTION "The tools turn a pinhole render and a few views from the rim of the lens into
a layered depth image, and that into pictures with depth of field, for any
focus and f-number.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libsparselens-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS # what sparselens-config.cmake finds
    "libfmt-dev, libimath-dev, libopencolorio-dev, libopenexr-dev, libtbb-dev, pkg-config")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS sparselens) # has the module for PNG, JPEG and TIFF
set(CPACK_COMPONENT_DEV_DESCRIPTION "The static library behind the tools, its headers, and the CMake files for
find_package(sparselens).")

if(SPARSELENS_LAB)
    list(APPEND CPACK_COMPONENTS_ALL lab)
    set(CPACK_DEBIAN_LAB_PACKAGE_NAME sparselens-lab)
    set(CPACK_DEBIAN_LAB_PACKAGE_SHLIBDEPS ON)
    set(CPACK_DEBIAN_LAB_PACKAGE_DEPENDS "python3, python3-matplotlib, python3-numpy, python3-openimageio, sparselens")
    set(CPACK_COMPONENT_LAB_DESCRIPTION "The laboratory: test scenes and their ray tracer, and the report of error
against run time.")
endif()
if(SPARSELENS_PYTHON)
    list(APPEND CPACK_COMPONENTS_ALL python)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-sparselens)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
    # The module is of one minor version of Python. The package sparselens has the module for PNG, JPEG and TIFF.
    math(EXPR next_python "${Python_VERSION_MINOR} + 1")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
        "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_python}), python3-numpy, sparselens")
    set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The Python module of sparselens: numpy arrays of views in, layered depth
images and pictures with depth of field out.")
endif()
include(CPack)
