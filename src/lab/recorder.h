// What a run leaves in its folder while it goes on:
//
//   series.csv              a row every record.every of simulated time and at the end of each stage
//   contacts.csv            every contact at the end of the last stage
//   stones.csv              every stone, likewise
//   bed.png, forces.png, displacements.png
//                           the bed, the force chains in it, and how far stones have moved, likewise
//   stages/STAGE-*          the same at the end of each stage, or of those of record.stages; tables of stages
//   paraview/*.pvd          a frame at the end of each of these stages, and every record.paraview_every
//   failure/                tables and a ParaView frame of the last state of a run that failed
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/archive.h"
#include "io/csv.h"
#include "lab/case.h"
#include "lab/measure.h"
#include "lab/paraview.h"
#include "lab/tables.h"

namespace trackbed {

/// The measures of series.csv: some general ones, forces, moments and displacements of every wall and body,
/// and those of `further` by name. Throws InputError for a name that is no measure, with the nearest.
std::vector<Measure> series_measures(const Simulation& sim, const std::vector<std::string>& further);

/// Stage names as parts of file names: letters, digits, point and dash stay.
std::string file_name_of(const std::string& stage);

class Recorder {
 public:
  Recorder(const Simulation& sim, RecordInput record, std::filesystem::path folder);

  /// Begins the files of a new run.
  void begin();
  /// Where the files stand; those of a run that is taken up again lose what was written after that.
  void archive(Archive& a);

  /// After each step: writes what is due.
  void after_step(const Simulation& sim);
  /// After the last step of a stage.
  void close_stage(const Simulation& sim);

  /// Writes the table that the stage which runs has left.
  void write_table(const Simulation& sim, const ResultTable& table) const;

  /// Writes the last state of a run that failed into the folder `failure`, which is returned.
  std::filesystem::path write_failure(const Simulation& sim) const;

 private:
  void add_row(const Simulation& sim);
  void write_tables(const Simulation& sim) const;
  void draw_pictures(const Simulation& sim) const;
  std::filesystem::path of_stage(const Simulation& sim, const char* file) const;

  RecordInput record_;
  std::filesystem::path folder_;
  std::vector<Measure> measures_;
  std::optional<CsvWriter> series_;
  Paraview paraview_;
  double row_due_, frame_due_;  // [s]
  std::int64_t row_step_ = -1;  // of the last row
  std::string row_stage_;
};

}  // namespace trackbed
