#include "lab/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "base/error.h"
#include "io/files.h"
#include "lab/picture_of_bed.h"

namespace trackbed {
namespace fs = std::filesystem;
namespace {

constexpr std::array general_columns{"contacts", "energy_kinetic", "energy_total"};
constexpr std::array wall_columns{".force_", ".moment_", ".displacement_"};

bool is_column_by_default(const std::string& name) {
  const auto contains = [&](const char* part) { return name.find(part) != std::string::npos; };
  return std::ranges::find(general_columns, name) != general_columns.end() ||
         std::ranges::any_of(wall_columns, contains);
}

std::vector<Column> series_columns(const std::vector<Measure>& measures) {
  std::vector<Column> columns{
      {"time", Dimension::time}, {"stage", Dimension::none, true}, {"step"}, {"dt", Dimension::time}};
  for (const Measure& m : measures) columns.push_back({m.name, m.dimension});
  return columns;
}

/// The first multiple of `every` after `time`.
double next_after(double time, double every) {
  const double next = (std::floor(time / every) + 1) * every;
  return next > time ? next : next + every;
}

}  // namespace

std::vector<Measure> series_measures(const Simulation& sim, const std::vector<std::string>& further) {
  const std::vector<Measure> all = measures_of(sim);
  std::vector<Measure> chosen;
  std::ranges::copy_if(all, std::back_inserter(chosen), is_column_by_default, &Measure::name);
  for (const Measure& m : measures_called(sim, further))
    if (std::ranges::find(chosen, m.name, &Measure::name) == chosen.end()) chosen.push_back(m);
  return chosen;
}

std::string file_name_of(const std::string& stage) {
  std::string name = stage;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
  return name;
}

Recorder::Recorder(const Simulation& sim, RecordInput record, fs::path folder)
    : record_(std::move(record)),
      folder_(std::move(folder)),
      measures_(series_measures(sim, record_.measures)),
      paraview_(folder_ / "paraview", record_.paraview_stones),
      row_due_(next_after(sim.state.time, record_.every)),
      frame_due_(record_.paraview_every ? next_after(sim.state.time, *record_.paraview_every)
                                        : std::numeric_limits<double>::infinity()) {}

void Recorder::begin() {
  series_.emplace(folder_ / "series.csv", series_columns(measures_));
}

void Recorder::archive(Archive& a) {
  std::uint64_t rows = series_ ? series_->rows() : 0;
  a(rows, paraview_, row_due_, frame_due_, row_step_, row_stage_);
  if (a.reads()) series_ = CsvWriter::resume(folder_ / "series.csv", series_columns(measures_), rows);
}

void Recorder::after_step(const Simulation& sim) {
  const double time = sim.state.time;
  if (time >= row_due_) {
    add_row(sim);
    row_due_ = next_after(time, record_.every);
  }
  if (time >= frame_due_) {
    paraview_.add_frame(sim, sim.places);
    frame_due_ = next_after(time, *record_.paraview_every);
  }
}

void Recorder::close_stage(const Simulation& sim) {
  if (row_step_ != sim.state.step || row_stage_ != sim.stage) add_row(sim);
  if (!record_.stages.empty() && std::ranges::find(record_.stages, sim.stage) == record_.stages.end()) return;
  paraview_.add_frame(sim, sim.places);
  if (record_.tables) write_tables(sim);
  if (record_.picture) draw_pictures(sim);
}

void Recorder::add_row(const Simulation& sim) {
  std::vector<Cell> row{sim.state.time, std::string_view(sim.stage), double(sim.state.step), sim.state.dt};
  for (const Measure& m : measures_) row.emplace_back(m.value(sim));
  series_->add_row(row);
  row_step_ = sim.state.step;
  row_stage_ = sim.stage;
}

void Recorder::write_tables(const Simulation& sim) const {
  write_contacts(sim, of_stage(sim, "contacts.csv"));
  write_stones(sim, sim.places, of_stage(sim, "stones.csv"));
  for (const char* table : {"contacts.csv", "stones.csv"})
    write_file(folder_ / table, read_file(of_stage(sim, table)));
}

void Recorder::draw_pictures(const Simulation& sim) const {
  draw_bed(sim, of_stage(sim, "bed.png"));
  draw_forces(sim, of_stage(sim, "forces.png"));
  draw_displacements(sim, displacements(sim.state, sim.places), record_.displacement_scale,
                     of_stage(sim, "displacements.png"));
  for (const char* picture : {"bed.png", "forces.png", "displacements.png"})
    write_file(folder_ / picture, read_file(of_stage(sim, picture)));
}

fs::path Recorder::of_stage(const Simulation& sim, const char* file) const {
  make_folder(folder_ / "stages");
  return folder_ / "stages" / fmt::format("{}-{}", file_name_of(sim.stage), file);
}

void Recorder::write_table(const Simulation& sim, const ResultTable& table) const {
  CsvWriter csv(of_stage(sim, (table.name + ".csv").c_str()), table.columns);
  for (const std::vector<double>& row : table.rows) csv.add_row(row);
}

fs::path Recorder::write_failure(const Simulation& sim) const {
  const fs::path folder = folder_ / "failure";
  Paraview(folder / "paraview", record_.paraview_stones).add_frame(sim, sim.places);
  write_contacts(sim, folder / "contacts.csv");
  write_stones(sim, sim.places, folder / "stones.csv");
  return folder;
}

}  // namespace trackbed
