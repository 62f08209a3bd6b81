target_sources(tessera_scene PRIVATE
  builtin.cpp builtin_bricks.cpp builtin_gate.cpp builtin_noise.cpp builtin_parts.cpp builtin_planet.cpp builtin_rocks.cpp builtin_small.cpp
  builtin_terrain.cpp)
