// A small family of objects with every type of parameter, for tests that must not depend on the real tables.
#pragma once

#include <string>

#include "renderer/params/node.h"

namespace brume::test_tables {

inline const Family& phase_family() {
  static const ParamTable isotropic{"isotropic", "Isotropic", "The same in every direction.", {}, {}};
  static const ParamTable lobe{"lobe",
                               "Lobe",
                               "One lobe.",
                               {param::number("g", "Mean cosine", 0).between(-0.99, 0.99).says("Forward > 0.")},
                               {}};
  static const Family family{"phase function", "type", {&isotropic, &lobe}};
  return family;
}

inline const Family& light_family() {
  static const ParamTable point{
      "point",
      "Point light",
      "Shines from a point.",
      {param::text("name", "Name"), param::flag("enabled", "On", true), param::point("position", "Position", 0, 0, 2),
       param::color("intensity", "Intensity", 10, 10, 10).in("W/sr")},
      {}};
  static const ParamTable sun{
      "sun", "Sun", "", {param::text("name", "Name"), param::vector("direction", "Direction", 0, 0, -1)}, {}};
  static const Family family{"light", "type", {&point, &sun}};
  return family;
}

inline const Family& volume_family() {
  static const ParamTable vdb{
      "vdb",
      "OpenVDB file",
      "A grid of a file.",
      {param::text("name", "Name"), param::file("file", "File").must_be_given().says("The .vdb file."),
       param::file("fire", "Fire file"), param::number("density_scale", "Density scale", 1).at_least(0),
       param::number("step", "Step", 0.03).more_than(0).in("world units").auto_by_default("the voxel size"),
       param::integer("samples", "Samples", 1).between(1, 256),
       param::choice(
           "sampling", "Sampling", "mis",
           {{"density", "Density", "dense | thick"}, {"equi_angular", "Equi-angular", ""}, {"mis", "MIS", "both"}}),
       param::color("albedo", "Albedo", 0.9, 0.9, 0.9).between(0, 1)},
      {{"phase", "Phase function", "Where light goes on.", &phase_family()}}};
  static const ParamTable slabs{"slabs",
                                "Slabs",
                                "Layers.",
                                {param::text("name", "Name"), param::numbers("edges", "Edges", {-1, 0, 1}),
                                 param::vector("scale", "Scale", 1, 1, 1), param::matrix("matrix", "Matrix")},
                                {{"phase", "Phase function", "Where light goes on.", &phase_family()}}};
  static const Family family{"volume", "shader", {&vdb, &slabs}};
  return family;
}

inline const Family& film_family() {
  static const ParamTable table{
      "film",
      "Film",
      "The picture.",
      {param::resolution("resolution", "Resolution", 640, 480).between(1, 16384),
       param::number("exposure", "Exposure", 0).between(-20, 20).in("stops").costs(Affects::Display),
       param::integer("seed", "Seed", 0)},
      {}};
  static const Family family{"film", "", {&table}};
  return family;
}

/// Film, lights and volumes: shaped like a scene.
inline const Family& studio_family() {
  static const ParamTable table{"studio",
                                "Studio",
                                "A little scene.",
                                {},
                                {{"film", "Film", "", &film_family()},
                                 {"volumes", "Volumes", "All volumes.", &volume_family(), true},
                                 {"lights", "Lights", "All lights.", &light_family(), true}}};
  static const Family family{"scene", "", {&table}};
  return family;
}

inline Node studio() { return Node(*studio_family().tables.front()); }

}  // namespace brume::test_tables
