# Every third-party part, all of it from Debian 12. docs/architecture.md says what each is there for.

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(CGAL 5.5 REQUIRED)
find_package(Ceres 2.1 REQUIRED)
find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc calib3d videoio imgcodecs aruco)
# VTK without COMPONENTS asks for Qt: name those that a target links, and no other.
find_package(VTK 9.1 REQUIRED COMPONENTS
  CommonCore CommonDataModel CommonExecutionModel FiltersCore
  IOImage IOXML
  RenderingCore RenderingOpenGL2 RenderingVolume RenderingVolumeOpenGL2)
find_package(DCMTK 3.6 REQUIRED CONFIG)
find_package(GDCM REQUIRED)
find_package(OpenIGTLink REQUIRED)
find_package(ZLIB REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto SSL)
find_package(CURL 7.85 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(spdlog 1.10 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(glfw3 3.3 REQUIRED)
find_package(GLEW REQUIRED)
find_package(OpenGL REQUIRED COMPONENTS OpenGL EGL)
find_package(PkgConfig REQUIRED)
pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)
find_library(ARTHRONAUT_HPDF hpdf REQUIRED)

if(ARTHRONAUT_BUILD_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
if(ARTHRONAUT_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
  find_library(ARTHRONAUT_APRILTAG apriltag REQUIRED)
  find_library(ARTHRONAUT_APRILTAG_UTILS apriltag-utils REQUIRED)
endif()
