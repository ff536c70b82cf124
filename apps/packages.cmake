# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause

# Debian packages by CPack: libgearmesh with its ABI version, libgearmesh-dev, gearsim. From a build for the place where
# they go, with shared libraries:
#     cmake --preset release -B build/package -DCMAKE_INSTALL_PREFIX=/usr -DBUILD_SHARED_LIBS=ON
#     cmake --build build/package --parallel
#     cpack --config build/package/CPackConfig.cmake -B build/package
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME gearmesh)
set(CPACK_PACKAGE_CONTACT "The gearmesh authors <gearmesh@invalid>")
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_CURRENT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL libraries development gearsim)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON) # of the system's libraries; those of this build are beside it
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
get_target_property(built_libraries gearmesh LIBRARY_OUTPUT_DIRECTORY)
get_filename_component(built_libraries "${built_libraries}" ABSOLUTE)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${built_libraries}")

set(library_package libgearmesh${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(of_this_version "(= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_NAME ${library_package})
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARIES_DESCRIPTION "contact of real helical gears: shared libraries")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libgearmesh-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${library_package} ${of_this_version}")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "contact of real helical gears: headers, CMake, pkg-config, Fortran module")
set(CPACK_DEBIAN_GEARSIM_PACKAGE_NAME gearsim)
set(CPACK_DEBIAN_GEARSIM_PACKAGE_DEPENDS "${library_package} ${of_this_version}")
set(CPACK_DEBIAN_GEARSIM_PACKAGE_RECOMMENDS "gnuplot-nox | gnuplot, python3-numpy, python3-scipy, python3-h5py")
set(CPACK_DEBIAN_GEARSIM_DESCRIPTION "simulator of gear pairs with real flanks: programs, scripts, documents, data")
include(CPack)
