# What Debian asks of each package beside the installed files: a copyright and a changelog, and manual pages that are
# compressed. CPack runs this before it makes the packages; their files lie in one folder a component.
set(package_tools ${CPACK_DEBIAN_TOOLS_PACKAGE_NAME})
set(package_dev ${CPACK_DEBIAN_DEV_PACKAGE_NAME})
set(package_lab ${CPACK_DEBIAN_LAB_PACKAGE_NAME})
set(package_python ${CPACK_DEBIAN_PYTHON_PACKAGE_NAME})

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

foreach(component IN LISTS CPACK_COMPONENTS_ALL)
    set(root ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr)
    set(doc ${root}/share/doc/${package_${component}})
    if(component STREQUAL python) # Debian's Python looks there; the build asked for the prefix's own folder
        file(GLOB modules ${root}/lib/python3.*/dist-packages/sparselens ${root}/local/lib/python3.*/dist-packages/sparselens)
        file(MAKE_DIRECTORY ${root}/lib/python3/dist-packages)
        file(RENAME ${modules} ${root}/lib/python3/dist-packages/sparselens)
        file(REMOVE_RECURSE ${root}/local)
        file(GLOB versions ${root}/lib/python3.*)
        file(REMOVE_RECURSE ${versions})
    endif()
    file(MAKE_DIRECTORY ${doc})
    file(WRITE ${doc}/copyright
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: sparselens

Files: *
Copyright: the sparselens developers
License: Apache-2.0
 On Debian systems the full text of the license is in
 /usr/share/common-licenses/Apache-2.0
")
    string(TIMESTAMP today "%a, %d %b %Y %H:%M:%S +0000" UTC) # that of SOURCE_DATE_EPOCH, where it is set
    file(WRITE ${doc}/changelog
"${package_${component}} (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * The changes are those of CHANGELOG.md in the package sparselens.

 -- ${CPACK_PACKAGE_CONTACT}  ${today}
")
    file(CHMOD ${doc}/copyright ${doc}/changelog PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
    file(GLOB pages ${root}/share/man/man1/*.1)
    run(gzip -9nf ${doc}/changelog ${pages})
    file(GLOB libraries ${root}/lib/*.a)
    if(libraries)
        run(strip --strip-debug --enable-deterministic-archives ${libraries})
    endif()
endforeach()
