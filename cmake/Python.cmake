# The Python module is built where pybind11 and Python are there. The Python of the system comes before others in PATH,
# because the packages that install pybind11 and numpy are the system's.
if(NOT DEFINED Python_ROOT_DIR AND NOT DEFINED Python_EXECUTABLE)
    set(Python_ROOT_DIR /usr)
endif()
find_package(Python 3.9 COMPONENTS Interpreter Development.Module QUIET)
if(Python_FOUND) # else pybind11 would look for one, and fail
    find_package(pybind11 2.10 CONFIG QUIET)
endif()
if(Python_FOUND AND pybind11_FOUND)
    set(python_can_be_built ON)
else()
    set(python_can_be_built OFF)
endif()
sparselens_found_option(SPARSELENS_PYTHON "Build the Python module (needs pybind11 2.10 and Python 3.9)" ${python_can_be_built}
    "the Python module" "pybind11 2.10 or Python 3.9 (Debian: pybind11-dev, python3-dev)")
if(NOT SPARSELENS_PYTHON)
    message(STATUS "The Python module is left out (SPARSELENS_PYTHON)")
    return()
endif()

# Where that Python looks for packages below the prefix; else where it would below a prefix of its own. A wheel has a folder for
# what goes there (pyproject.toml).
if(SKBUILD)
    set(SPARSELENS_PYTHON_DIR ${SKBUILD_PLATLIB_DIR})
    return()
endif()
execute_process(COMMAND ${Python_EXECUTABLE} -c [[
import os, site, sys, sysconfig
below = [os.path.relpath(folder, sys.argv[1]) for folder in site.getsitepackages()]
below = [folder for folder in below if not folder.startswith('..')]
print(min(below, key=len) if below else os.path.relpath(sysconfig.get_path('platlib'), sys.prefix))
]] ${CMAKE_INSTALL_PREFIX} OUTPUT_VARIABLE python_dir OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
set(SPARSELENS_PYTHON_DIR ${python_dir} CACHE PATH "Where the Python module is installed, below the prefix")
mark_as_advanced(SPARSELENS_PYTHON_DIR)
message(STATUS "The Python module is built for ${Python_EXECUTABLE} ${Python_VERSION} and installed into ${SPARSELENS_PYTHON_DIR}")
