# Third-party libraries as imported targets. Their headers count as system headers, so they raise no warnings.
#
#   brume::openvdb brume::nanovdb brume::embree TBB::tbb OpenEXR::OpenEXR Imath::Imath PNG::PNG
#   nlohmann_json::nlohmann_json hwy::hwy tinyobjloader::tinyobjloader Threads::Threads     for the renderer
#   brume::imgui brume::stb glfw brume::osmesa brume::egl CLI11::CLI11         for the program
#   GTest::gtest_main benchmark::benchmark                                     for the tests
#
# Everything is looked for before anything is complained about: one message names all that is missing.

set(BRUME_MISSING "")

# brume_need(<condition> <what> <Debian package>): notes what is missing when the condition is false.
macro(brume_need condition what package)
  if(NOT (${condition}))
    string(APPEND BRUME_MISSING "\n  Brume needs ${what}: apt-get install ${package}, or run third_party/install.sh")
  endif()
endmacro()

# brume_find_config(<target> <what> <Debian package> <find_package arguments>...): a package with a CMake config file.
macro(brume_find_config target what package)
  find_package(${ARGN} QUIET CONFIG)
  brume_need("TARGET;${target}" "${what}" ${package})
endmacro()

# brume_find_pkg_config(<name> <pkg-config module> <what> <Debian package>): makes the target brume::<name>.
macro(brume_find_pkg_config name module what package)
  if(PKG_CONFIG_FOUND)
    pkg_check_modules(BRUME_${name} QUIET IMPORTED_TARGET GLOBAL ${module})
  endif()
  if(TARGET PkgConfig::BRUME_${name})
    add_library(brume::${name} ALIAS PkgConfig::BRUME_${name})
  endif()
  brume_need("TARGET;brume::${name}" "${what}" ${package})
endmacro()

find_package(Threads REQUIRED)
find_package(PkgConfig QUIET)
brume_need(PKG_CONFIG_FOUND "pkg-config" pkg-config)

# ---- Renderer -------------------------------------------------------------------------------------------------------

brume_find_config(TBB::tbb "oneTBB" libtbb-dev TBB)
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)  # Debian's Imath remarks on a Python library that it packages apart
brume_find_config(OpenEXR::OpenEXR "OpenEXR 3" libopenexr-dev OpenEXR 3)
brume_find_config(Imath::Imath "Imath 3" libimath-dev Imath 3)
unset(CMAKE_MESSAGE_LOG_LEVEL)
brume_find_config(nlohmann_json::nlohmann_json "JSON for Modern C++" nlohmann-json3-dev nlohmann_json 3)
brume_find_config(hwy::hwy "Highway" libhwy-dev hwy)

find_package(PNG QUIET)
brume_need("TARGET;PNG::PNG" "libpng" libpng-dev)

# OpenVDB ships a find module, but it asks for a Boost library that nothing here uses, and its folder holds modules that
# shadow the config files of TBB and OpenEXR. The header and the library are enough: version.h has all feature switches.
find_path(OPENVDB_INCLUDE_DIR openvdb/openvdb.h)
find_library(OPENVDB_LIBRARY openvdb)
find_path(BOOST_INCLUDE_DIR boost/version.hpp)
mark_as_advanced(OPENVDB_INCLUDE_DIR OPENVDB_LIBRARY BOOST_INCLUDE_DIR)
brume_need("OPENVDB_INCLUDE_DIR;AND;OPENVDB_LIBRARY" "OpenVDB 10 or newer" libopenvdb-dev)
brume_need(BOOST_INCLUDE_DIR "the Boost headers that OpenVDB's headers include" libboost-dev)
if(OPENVDB_INCLUDE_DIR AND OPENVDB_LIBRARY)
  file(STRINGS ${OPENVDB_INCLUDE_DIR}/openvdb/version.h version_line
    REGEX "define OPENVDB_LIBRARY_MAJOR_VERSION_NUMBER [0-9]+")
  string(REGEX MATCH "[0-9]+$" OPENVDB_MAJOR "${version_line}")
  if(NOT OPENVDB_MAJOR OR OPENVDB_MAJOR LESS 10)
    brume_need(FALSE "OpenVDB 10 or newer (found ${OPENVDB_MAJOR})" libopenvdb-dev)
  endif()
  add_library(brume::openvdb UNKNOWN IMPORTED)
  set_target_properties(brume::openvdb PROPERTIES
    IMPORTED_LOCATION ${OPENVDB_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES "${OPENVDB_INCLUDE_DIR};${BOOST_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "TBB::tbb;Imath::Imath")
endif()

# NanoVDB is headers only. Its file format number tells the versions apart: 32 came with OpenVDB 10; OpenVDB 11 and 12
# moved headers and renamed the converter, which the code follows with __has_include.
find_path(NANOVDB_INCLUDE_DIR nanovdb/NanoVDB.h)
mark_as_advanced(NANOVDB_INCLUDE_DIR)
brume_need(NANOVDB_INCLUDE_DIR "NanoVDB 32 or newer" libnanovdb-dev)
if(NANOVDB_INCLUDE_DIR)
  file(STRINGS ${NANOVDB_INCLUDE_DIR}/nanovdb/NanoVDB.h version_line
    REGEX "define NANOVDB_MAJOR_VERSION_NUMBER [0-9]+" LIMIT_COUNT 1)
  string(REGEX REPLACE ".*NUMBER ([0-9]+).*" "\\1" NANOVDB_MAJOR "${version_line}")
  if(NOT NANOVDB_MAJOR OR NANOVDB_MAJOR LESS 32)
    brume_need(FALSE "NanoVDB 32 or newer (found ${NANOVDB_MAJOR})" libnanovdb-dev)
  endif()
  add_library(brume::nanovdb INTERFACE IMPORTED)
  set_target_properties(brume::nanovdb PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${NANOVDB_INCLUDE_DIR}
    INTERFACE_COMPILE_DEFINITIONS "NANOVDB_USE_OPENVDB;NANOVDB_USE_INTRINSICS"
    INTERFACE_LINK_LIBRARIES TBB::tbb)
  # libtbb is not built for the thread sanitizer, which would report its every hand-over.
  if(NOT BRUME_SANITIZE STREQUAL "thread")
    set_property(TARGET brume::nanovdb APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS NANOVDB_USE_TBB)
  endif()
endif()

# Embree 4, else 3. The code sees which one as BRUME_EMBREE_VERSION.
find_package(embree 4 QUIET CONFIG)
if(NOT TARGET embree)
  find_package(embree 3 QUIET CONFIG)
endif()
brume_need("TARGET;embree" "Embree 3 or 4" libembree-dev)
if(TARGET embree)
  string(REGEX MATCH "^[0-9]+" embree_major "${embree_VERSION}")
  add_library(brume::embree INTERFACE IMPORTED)
  set_target_properties(brume::embree PROPERTIES
    INTERFACE_COMPILE_DEFINITIONS BRUME_EMBREE_VERSION=${embree_major}
    INTERFACE_LINK_LIBRARIES embree)
endif()

brume_find_config(tinyobjloader::tinyobjloader "tinyobjloader" libtinyobjloader-dev tinyobjloader)
brume_find_pkg_config(xxhash libxxhash "xxHash" libxxhash-dev)

# ---- Program --------------------------------------------------------------------------------------------------------

brume_find_config(glfw "GLFW 3.3 or newer" libglfw3-dev glfw3 3.3)
brume_find_config(CLI11::CLI11 "CLI11" libcli11-dev CLI11 2)
brume_find_pkg_config(imgui imgui "Dear ImGui" libimgui-dev)
brume_find_pkg_config(stb stb "stb" libstb-dev)
brume_find_pkg_config(osmesa osmesa "OSMesa" libosmesa6-dev)
brume_find_pkg_config(egl egl "EGL" libegl-dev)
if(TARGET brume::imgui AND TARGET glfw)
  # The packaged static library holds the GLFW backend, so GLFW comes after it on the link line.
  target_link_libraries(PkgConfig::BRUME_imgui INTERFACE glfw)
endif()

# OpenGL is called only through pointers that the context hands out, so the headers are all that is needed of it.
find_path(GLCOREARB_INCLUDE_DIR GL/glcorearb.h)
mark_as_advanced(GLCOREARB_INCLUDE_DIR)
brume_need(GLCOREARB_INCLUDE_DIR "the OpenGL headers" libgl-dev)

find_file(BRUME_FONT_FILE Roboto-Regular.ttf
  PATHS /usr/share/fonts/truetype/roboto /usr/share/fonts/truetype/roboto/unhinted
  PATH_SUFFIXES RobotoTTF unhinted/RobotoTTF)
find_file(BRUME_FONT_LICENSE copyright PATHS /usr/share/doc/fonts-roboto-unhinted NO_DEFAULT_PATH)
mark_as_advanced(BRUME_FONT_FILE BRUME_FONT_LICENSE)
brume_need(BRUME_FONT_FILE "the font Roboto" fonts-roboto-unhinted)

# ---- Tests ----------------------------------------------------------------------------------------------------------

if(BRUME_BUILD_TESTS)
  brume_find_config(GTest::gtest_main "GoogleTest" libgtest-dev GTest)
  brume_find_config(benchmark::benchmark "Google Benchmark" libbenchmark-dev benchmark)
  find_program(BRUME_XVFB_RUN xvfb-run)  # only the tests of a real window need it
  mark_as_advanced(BRUME_XVFB_RUN)
endif()

if(BRUME_MISSING)
  message(FATAL_ERROR "Missing libraries:${BRUME_MISSING}\n")
endif()
