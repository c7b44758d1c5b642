# `cpack -G DEB` in the build folder makes three packages: tuft (the command line, brushes, inks, models, samples),
# tuft-studio (the window) and tuft-dev (headers, libraries, CMake package). They go to /usr.
set(TUFT_MAINTAINER "the tuft authors <maintainers@tuft.invalid>" CACHE STRING "Maintainer of the packages: NAME <ADDRESS>")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT ${TUFT_MAINTAINER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL tuft dev)
if(TUFT_STUDIO)
  list(APPEND CPACK_COMPONENTS_ALL studio)
endif()
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(same_version "(= ${PROJECT_VERSION}-1)")

# Packages whose libraries the sources are compiled against; what a program loads is found out by dpkg-shlibdeps.
set(CPACK_DEBIAN_TUFT_PACKAGE_NAME tuft)
set(CPACK_DEBIAN_TUFT_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_TUFT_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_TUFT_PACKAGE_SUGGESTS "tuft-studio, ffmpeg")
set(CPACK_DEBIAN_TUFT_DESCRIPTION "ink and a bending hair brush on the surface of 3D models
tuft makes a texture atlas for a product, clay or scan mesh, lets a physically
bending brush touch the real curved surface, leaves ink in the texels that it
touched, and writes a textured model. Strokes are kept as motions of the hand,
and are painted again on other models, at other resolutions, with other inks.

This package has the program for the command line, brushes, inks, models and
samples.")

set(CPACK_DEBIAN_STUDIO_PACKAGE_NAME tuft-studio)
set(CPACK_DEBIAN_STUDIO_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_STUDIO_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_STUDIO_PACKAGE_DEPENDS "tuft ${same_version}, libgl1, libegl1")
set(CPACK_DEBIAN_STUDIO_PACKAGE_RECOMMENDS "libgl1-mesa-dri, fonts-dejavu-core | fonts-noto-core")
set(CPACK_DEBIAN_STUDIO_PACKAGE_SUGGESTS "fonts-noto-cjk, spacenavd")
set(CPACK_DEBIAN_STUDIO_DESCRIPTION "paint on 3D models with ink and a bending hair brush
tuft-studio opens a 3D model, makes a texture atlas for it, and paints on its
surface with a physically bending brush, by mouse, pen tablet or SpaceMouse:
layers, masks, a palette to mix inks on, drawings placed from SVG and InkML,
and a journal of strokes that can be taken back and painted again.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME tuft-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
string(JOIN ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "tuft ${same_version}" libglm-dev libopenmesh-dev libembree-dev
  libtbb-dev libfmt-dev libtinygltf-dev libsqlite3-dev libsqlitecpp-dev libzstd-dev libpng-dev zlib1g-dev libxxhash-dev
  libpugixml-dev libfontconfig-dev libfreetype-dev libharfbuzz-dev
  libmeshoptimizer-dev libpodofo-dev libpolyclipping-dev libtomlplusplus-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS "cmake, pkg-config")
set(CPACK_DEBIAN_DEV_DESCRIPTION "libraries that unwrap 3D models and paint on them
Headers, static libraries and the CMake package of tuft, for programs that
unwrap meshes and paint on them from code; with an example of sixty lines.")

include(CPack)
