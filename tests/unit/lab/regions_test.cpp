// Parts of space by name.
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "lab/case.h"
#include "scenes/temporary_folder.h"

namespace trackbed {
namespace {

class Regions : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_.path / name) << text; }
  Region make(const std::string& table) {
    const std::string text = R"toml(
title = "regions"
[materials.ballast]
kn = "1e7 N/m"
ks = "1e7 N/m"
[regions.it]
)toml" + table + "\n[[stages]]\nkind = \"hold\"\nduration = \"1 s\"\n";
    const Document document = Document::from_text(text, folder_.path / "case.toml", {});
    CaseInput input;
    document.read(input);
    return input.regions.at("it").input->make();
  }
  TemporaryFolder folder_;
};

TEST_F(Regions, BoxAndLayer) {
  const Region box =
      make("kind = \"box\"\nfrom = [\"0 m\", \"0 m\", \"0 m\"]\nto = [\"1 m\", \"2 m\", \"3 m\"]");
  EXPECT_TRUE(box({0.5, 1.9, 0.1}));
  EXPECT_FALSE(box({0.5, 2.1, 0.1}));
  const Region layer = make("kind = \"box\"\nabove = \"100 mm\"\nbelow = \"200 mm\"");
  EXPECT_TRUE(layer({7, -8, 0.15}));
  EXPECT_FALSE(layer({7, -8, 0.25}));
  EXPECT_FALSE(layer({7, -8, 0.05}));
}

TEST_F(Regions, InsideOfAMesh) {
  write("tetrahedron.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const Region region = make("kind = \"mesh\"\nfile = \"tetrahedron.obj\"\nunit = \"100 mm\"");
  EXPECT_TRUE(region({0.02, 0.02, 0.02}));
  EXPECT_FALSE(region({0.04, 0.04, 0.04}));
}

TEST_F(Regions, FieldIsWhereItsNearestPointIsAboveTheLimit) {
  write("way.csv", "x [m],y [m],z [m],way [mm]\n0,0,0,1\n1,0,0,3\n");
  const Region region = make("kind = \"field\"\nfile = \"way.csv\"\nabove = 2");
  EXPECT_FALSE(region({0.4, 0.3, 0}));
  EXPECT_TRUE(region({0.6, 0.3, 0}));
}

TEST_F(Regions, FieldTellsTheLineThatIsWrong) {
  write("way.csv", "x,y,z,way\n0,0,0,1\n1,0,0\n");
  try {
    make("kind = \"field\"\nfile = \"way.csv\"\nabove = 2");
    FAIL() << "three numbers were taken for a point with a value";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), (folder_.path / "way.csv").string() + ":3: a line is x,y,z,value");
  }
}

}  // namespace
}  // namespace trackbed
