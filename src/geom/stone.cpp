#include "geom/stone.h"

#include <cmath>
#include <utility>

#include "base/error.h"
#include "geom/mass_properties.h"

namespace trackbed {

Stone make_stone(const TriangleMesh& solid, const std::string& name, const ClumpFilling& filling) {
  const MassProperties mass = mass_properties(solid);
  TriangleMesh surface = in_principal_frame(solid, mass);
  std::vector<Pebble> pebbles = fill_with_pebbles(surface, filling);
  if (pebbles.empty()) throw InputError(name + ": no pebble fits inside; is the mesh too thin?");
  if (filling.enlarge) {
    const double scale = std::cbrt(1 / clump_error(surface, pebbles).volume_ratio);
    for (Pebble& p : pebbles) p = {p.centre * scale, p.radius * scale};
  }
  Stone stone;
  stone.shape = measure_shape(surface);
  stone.error = clump_error(surface, pebbles);
  stone.clump = make_clump_template(name, std::move(pebbles), mass.volume, mass.principal, std::move(surface),
                                    stone.shape.sieve_size);
  stone.clump.pebble_volume = stone.error.volume_ratio * mass.volume;
  return stone;
}

}  // namespace trackbed
