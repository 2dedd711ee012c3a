# Whether the Python package is built (python/), and with which Python.
if(NOT DEFINED Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)  # Debian's, whose GDAL rasterio and geopandas share, before any other
endif()
find_package(Python3 QUIET COMPONENTS Interpreter Development.Module NumPy)
if(Python3_FOUND)  # pybind11 would look for another Python
  find_package(pybind11 2.10 QUIET CONFIG)
endif()
set(python_found OFF)
if(Python3_FOUND AND pybind11_FOUND)
  set(python_found ON)
endif()
set(python_wanted ${python_found})
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  set(python_wanted OFF)  # Python itself would have to be started with the sanitizer's library
endif()
option(WAYMARK_PYTHON "Build the Python package (Debian: pybind11-dev, python3-dev, python3-numpy)" ${python_wanted})
if(WAYMARK_PYTHON AND NOT python_found)
  message(FATAL_ERROR "WAYMARK_PYTHON needs pybind11-dev, python3-dev and python3-numpy: scripts/install-packages")
endif()
if(NOT WAYMARK_PYTHON)
  message(STATUS "Python package: OFF; scripts/install-packages installs pybind11-dev, python3-dev and python3-numpy")
endif()
