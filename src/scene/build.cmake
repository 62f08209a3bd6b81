target_sources(tessera_scene PRIVATE
  bounds.cpp
  build.cpp
  cluster_build.cpp
  color_texture.cpp
  directions.cpp
  height_map.cpp
  height_ranges.cpp
  material_build.cpp
  mesh_vertices.cpp
  seams.cpp
  traits.cpp
  weld.cpp)
target_link_libraries(tessera_scene PRIVATE meshoptimizer::meshoptimizer)
