# Install rules and a package config: find_package(sparselens) gives the target sparselens::sparselens.
include(CMakePackageConfigHelpers)

install(TARGETS sparselens EXPORT sparselens-targets
        ARCHIVE COMPONENT dev LIBRARY COMPONENT tools NAMELINK_COMPONENT dev RUNTIME COMPONENT tools)
install(TARGETS sparselens_oiio LIBRARY DESTINATION ${SPARSELENS_MODULES})
install(EXPORT sparselens-targets NAMESPACE sparselens:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sparselens COMPONENT dev)

configure_package_config_file(cmake/sparselens-config.cmake.in sparselens-config.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sparselens)
write_basic_package_version_file(sparselens-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sparselens-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/sparselens-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/sparselens COMPONENT dev)
install(DIRECTORY share/ocio share/blender share/nuke share/comfyui share/lenses share/openjd share/slurm share/opencue
        share/deadline share/flamenco
        share/python DESTINATION ${CMAKE_INSTALL_DATADIR}/sparselens USE_SOURCE_PERMISSIONS
        PATTERN __pycache__ EXCLUDE)
install(FILES $<$<NOT:$<PLATFORM_ID:Windows>>:${CMAKE_BINARY_DIR}/share/blender/looks.json> LICENSE # the zip of this folder goes to others
        DESTINATION ${CMAKE_INSTALL_DATADIR}/sparselens/blender/sparselens_blender)
install(FILES LICENSE README.md CHANGELOG.md CONTRIBUTING.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR}) # headers cite design.md
install(DIRECTORY share/images share/blender share/lenses share/openjd share/slurm share/opencue
        share/deadline share/flamenco
        DESTINATION ${CMAKE_INSTALL_DOCDIR}/share USE_SOURCE_PERMISSIONS PATTERN __pycache__ EXCLUDE)
