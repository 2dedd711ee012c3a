# Single modules of OpenCV: find_package(OpenCVParts COMPONENTS core imgproc) gives targets opencv_core, opencv_imgproc.
# OpenCV's own package file wants all its modules installed, 230 Debian packages that nothing of ours uses.
include(FindPackageHandleStandardArgs)
find_path(OpenCVParts_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4)
foreach(part IN LISTS OpenCVParts_FIND_COMPONENTS)
  find_library(OpenCVParts_${part}_LIBRARY opencv_${part})
  if(OpenCVParts_${part}_LIBRARY AND EXISTS ${OpenCVParts_INCLUDE_DIR}/opencv2/${part}.hpp)
    set(OpenCVParts_${part}_FOUND TRUE)
    if(NOT TARGET opencv_${part})
      add_library(opencv_${part} UNKNOWN IMPORTED)
      set_target_properties(opencv_${part} PROPERTIES IMPORTED_LOCATION ${OpenCVParts_${part}_LIBRARY}
                            INTERFACE_INCLUDE_DIRECTORIES ${OpenCVParts_INCLUDE_DIR})
    endif()
  endif()
endforeach()
find_package_handle_standard_args(OpenCVParts REQUIRED_VARS OpenCVParts_INCLUDE_DIR HANDLE_COMPONENTS)
mark_as_advanced(OpenCVParts_INCLUDE_DIR)
