# What each folder takes from outside; docs/dependencies.md says why.
find_package(fmt REQUIRED)
target_link_libraries(trackbed_base PUBLIC fmt::fmt)

find_package(Boost 1.74 REQUIRED)
target_link_libraries(trackbed_lab PRIVATE Boost::headers)

find_package(CGAL 5.5 REQUIRED)
target_link_libraries(trackbed_geom PRIVATE CGAL::CGAL)

find_package(nlohmann_json 3.11 REQUIRED)
find_package(ZLIB REQUIRED)
find_package(PNG REQUIRED)
target_link_libraries(trackbed_io PUBLIC nlohmann_json::nlohmann_json PRIVATE ZLIB::ZLIB PNG::PNG)
# toml++ (headers only) sits behind this one file; its assertions would abort on some broken input.
set_source_files_properties(io/toml.cpp PROPERTIES COMPILE_OPTIONS -DNDEBUG)

# The BLAS that CHOLMOD uses is chosen when the program is loaded (libblas.so.3): on Debian OpenBLAS as soon as it is installed.
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_path(CHOLMOD_INCLUDE cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(OPENBLAS_LIBRARY openblas REQUIRED)
find_path(OPENBLAS_INCLUDE cblas.h PATH_SUFFIXES openblas-pthread openblas-openmp REQUIRED)
target_link_libraries(trackbed_fem PRIVATE ${CHOLMOD_LIBRARY} ${OPENBLAS_LIBRARY})
target_include_directories(trackbed_fem SYSTEM PRIVATE ${CHOLMOD_INCLUDE} ${OPENBLAS_INCLUDE})
