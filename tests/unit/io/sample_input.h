// An input with every sort of field, for the tests of reading, describing and echoing.
#pragma once

#include "io/schema.h"

namespace trackbed::sample {

struct Material {
  double density = 0;  // [kg/m^3]
  double friction = 0.5;
};
inline void declare(Fields& f, Material& in) {
  f.quantity(required("density"), in.density, Dimension::density, {.above = 0}, "of the rock");
  f.number("friction", in.friction, {.at_least = 0, .at_most = 10}, "Coulomb coefficient");
}

struct Contact {
  std::string law = "linear";
  double kn = 1e7;                 // [N/m]
  std::optional<double> friction;  // of all contacts
  bool rolling = false;
};
inline void declare(Fields& f, Contact& in) {
  f.choice("law", in.law, {"linear", "hertz"}, "contact law");
  f.quantity("kn", in.kn, Dimension::stiffness, {.above = 0, .at_most = 1e12}, "normal stiffness");
  f.number("friction", in.friction, {.at_least = 0, .at_most = 10}, "Coulomb coefficient of all contacts");
  f.flag("rolling", in.rolling, "resistance to rolling");
}

struct Stage {
  virtual ~Stage() = default;
  std::string name;
};
struct Settle : Stage {
  double unbalanced_ratio = 1e-3;
  double time_limit = 0;  // [s]
};
struct Load : Stage {
  double force_min = 0, force_max = 1e3;  // [N]
};
struct Cycle : Stage {
  unsigned count = 1;
  std::vector<OneOf<Stage>> stages;
};

inline const Kinds<Stage>& stage_kinds();

inline void declare(Fields& f, Settle& in) {
  f.text("name", in.name, "name of the stage");
  f.number("unbalanced_ratio", in.unbalanced_ratio, {.above = 0, .at_most = 1}, "stop below this ratio");
  f.quantity(required("time_limit"), in.time_limit, Dimension::time, {.above = 0}, "fail after this time");
}
inline void declare(Fields& f, Load& in) {
  f.text("name", in.name, "name of the stage");
  f.quantity("force_min", in.force_min, Dimension::force, {.at_least = 0}, "lowest force");
  f.quantity("force_max", in.force_max, Dimension::force, {.above = 0}, "highest force");
  f.check(in.force_min < in.force_max, "force_max", "force_max must be above force_min",
          "force_min is " + to_text(in.force_min, Dimension::force));
  f.gives("peak", Dimension::force, "the largest force");
  f.gives("force_at_NUMBER_s", Dimension::force, "force at a time that nobody asks for", false);
}
inline void declare(Fields& f, Cycle& in) {
  f.text("name", in.name, "name of the stage");
  f.integer("count", in.count, {.at_least = 1}, "how often");
  f.sequence(required("stages"), in.stages, stage_kinds(), "what is repeated");
}
inline const Kinds<Stage>& stage_kinds() {
  static const Kinds<Stage> kinds{"stage",
                                  {kind_of<Stage, Settle>("settle", "wait until the stones are at rest"),
                                   kind_of<Stage, Load>("load", "a force over time"),
                                   kind_of<Stage, Cycle>("cycle", "repeat a list of stages")}};
  return kinds;
}

struct Output {
  double every = 0.01;  // [s]
};
inline void declare(Fields& f, Output& in) {
  f.quantity("every", in.every, Dimension::time, {.above = 0}, "period");
}

struct Case {
  std::string title;
  std::uint64_t seed = 1;
  Vec3 gravity = Vec3(0, 0, -9.81);             // [m/s^2]
  std::vector<double> sieves = {0.0224, 0.05};  // [m]
  std::vector<std::string> measures = {"settlement"};
  std::vector<std::filesystem::path> files;
  std::optional<std::filesystem::path> mesh;
  Contact contact;
  std::optional<Output> output;
  std::map<std::string, Material> materials;
  std::vector<OneOf<Stage>> stages;
};
inline void declare(Fields& f, Case& in) {
  f.text(required("title"), in.title, "what the case is about");
  f.integer("seed", in.seed, {}, "of the random numbers");
  f.vector("gravity", in.gravity, Dimension::acceleration, {}, "x, y and z");
  f.quantities("sieves", in.sieves, Dimension::length, {.above = 0}, "sizes of the sieves");
  f.choices("measures", in.measures, {"settlement", "porosity"}, "what is recorded");
  f.paths("files", in.files, "meshes of stones");
  f.path("mesh", in.mesh, "mesh of the box");
  f.section("contact", in.contact, "how stones touch");
  f.section("output", in.output, "pictures");
  f.table("materials", in.materials, "materials by name");
  f.sequence("stages", in.stages, stage_kinds(), "what happens, in order");
}

inline constexpr const char* good_text = R"(title = "Cyclic box"
seed = 7
gravity = ["0 m/s^2", "0 m/s^2", "-1 g"]
sieves = ["22.4 mm", "31.5 mm"]
measures = ["porosity"]

[contact]
law = "hertz"
kn = "10 kN/mm"

[materials.ballast]
density = "2650 kg/m^3"

[[stages]]
kind = "settle"
name = "rest"
time_limit = "5 s"

[[stages]]
kind = "cycle"
count = 3
stages = [{ kind = "load", name = "seat", force_max = "20 kN" }]
)";

}  // namespace trackbed::sample
