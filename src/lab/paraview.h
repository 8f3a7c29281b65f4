// ParaView files of a run: stones.pvd, contacts.pvd and walls.pvd, each one time series.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/vtk.h"
#include "lab/simulation.h"
#include "lab/tables.h"

namespace trackbed {

/// Writes frames into a folder. Contacts are lines, one for each two bodies in touch: between the centres of
/// two stones, or from a stone's centre to where it touches a wall.
class Paraview {
 public:
  /// `stones`: surfaces, pebbles or none. Throws RunError when the folder cannot be written.
  Paraview(std::filesystem::path folder, std::string stones);

  /// Adds a frame of the present state, with the displacements of stones from `before`; replaces the last one
  /// when no time has passed (a stage that places things).
  void add_frame(const Simulation& sim, const StonePlaces& before);

  template <class A>
  void archive(A& a) {
    a(stone_series_, contact_series_, wall_series_, frame_, time_);
  }

 private:
  void add(TimeSeries& series, const char* name, const PolyData& data, bool is_new);

  std::filesystem::path folder_;
  std::string stones_;
  TimeSeries stone_series_, contact_series_, wall_series_;
  int frame_ = -1;   // the last one written
  double time_ = 0;  // its time [s]
};

}  // namespace trackbed
