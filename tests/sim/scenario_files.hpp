// Scenario and route files of a test in a temporary folder.
#pragma once

#include <fstream>
#include <string>

#include "sim/scenario.hpp"
#include "tests/support/temp_dir.hpp"

namespace sim {

class ScenarioFiles {
 public:
  ScenarioFiles() {
    Write("route.toml",
          "[route]\n"
          "start = {X = 10.0, Y = 0.0, psi = 0.0}\n"
          "speed = 12.0\n"
          "pieces = [\n"
          "  {kind = \"straight\", length = 60.0},\n"
          "  {kind = \"clothoid\", length = 40.0, curvature_from = 0.0, curvature_to = 0.01},\n"
          "  {kind = \"arc\", length = 60.0, curvature = 0.01},\n"
          "]\n"
          "[road]\nleft = 4.0\nright = 3.0\n");
  }

  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
  }
  // Loads a scenario whose file has `text` after the lines for name and route.
  [[nodiscard]] Scenario Load(const std::string& text) const {
    Write("scenario.toml", "name = \"test\"\nroute = \"route.toml\"\n" + text);
    return LoadScenario(folder_.path() / "scenario.toml");
  }
  [[nodiscard]] std::filesystem::path folder() const { return folder_.path(); }

 private:
  test_support::TempDir folder_;
};

}  // namespace sim
