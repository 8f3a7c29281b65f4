# What each folder takes from outside; docs/dependencies.md says why.
find_package(fmt REQUIRED)
target_link_libraries(trackbed_base PUBLIC fmt::fmt)
