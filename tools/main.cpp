// lpvmpc: offline commands about the controller, a file each.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "config/text_file.hpp"
#include "loop/config.hpp"
#include "tools/bench/bench_qp.hpp"
#include "tools/bench/bench_step.hpp"
#include "tools/commands/decode.hpp"
#include "tools/commands/report.hpp"
#include "tools/commands/run.hpp"
#include "tools/paper/paper.hpp"
#include "tools/scenarios/scenario_seed.hpp"
#include "tools/sweep/sweep.hpp"
#include "tools/sweep/sweep_config.hpp"

namespace {

constexpr int kBadInput = 2;

int Fail(const std::exception& error) {
  std::cerr << "lpvmpc: " << error.what() << '\n';
  return kBadInput;
}

// Ours beside the program: in the folder of a build as where it is installed.
std::string Scenarios(const char* part) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  return program.parent_path().parent_path() / "share/lpvmpcd/scenarios" / part;
}

// The status of a command whose output has reached stdout.
int Finish(int status) {
  if (!std::cout.flush()) throw std::runtime_error("standard output: cannot be written");
  return status;
}

int Decode(const std::string& log) {
  if (log != "-") {
    std::ifstream file = config::OpenTextFile(log);
    return tools::RunDecode(file, log, std::cout, std::cerr);
  }
  const int status = tools::RunDecode(std::cin, "standard input", std::cout, std::cerr);
  if (std::ferror(stdin) != 0)
    throw std::runtime_error("standard input: cannot be read");  // cin does not tell it
  return status;
}

// Not CLI11's own check, which would hide an unknown option.
void RequireOption(const CLI::App& command, const char* option) {
  if (command.parsed() && command.count(option) == 0) throw CLI::RequiredError(option);
}

// "--speed LO HI" and "--mu LO HI".
void AddRanges(CLI::App& command, tools::ScenarioRanges& ranges) {
  const auto add = [&command](const char* option, tools::Interval& range, const std::string& what) {
    command
        .add_option_function<std::vector<double>>(
            option, [&range](const std::vector<double>& ends) { range = {.low = ends[0], .high = ends[1]}; },
            what)
        ->type_name("LO HI")
        ->expected(2)
        ->default_str(fmt::format("{} {}", range.low, range.high));
  };
  add("--speed", ranges.speed, "target speeds of a sweep [m/s]");
  add("--mu", ranges.mu, "friction coefficients of a sweep");
}

const CLI::Range kSeeds(std::uint64_t{0}, tools::kSeedEnd - 1);

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("lpvmpc: offline commands about the controller");
  app.require_subcommand(0, 1);
  app.footer(
      "Exit status: 0 done; 1 expectations not met, or lines of a log not understood; 2 bad usage, input or "
      "output.");
  app.set_version_flag("--version", "lpvmpc " LPVMPC_VERSION);

  const std::string controllers = fmt::format("{}", fmt::join(loop::ControllerNames(), ", "));
  tools::RunOptions run;
  CLI::App* run_command = app.add_subcommand("run", "drive a scenario in memory, without a bus");
  CLI::Option* scenario = run_command->add_option("--scenario", run.scenario, "scenario in TOML");
  CLI::Option* sweep_seed =
      run_command->add_option("--sweep-seed", run.sweep_seed, "instead: seed of a scenario of a sweep")
          ->check(kSeeds)
          ->excludes(scenario);
  AddRanges(*run_command, run.ranges);
  for (const char* range : {"--speed", "--mu"}) run_command->get_option(range)->needs(sweep_seed);
  run_command->add_option("--config", run.config, "daemon's configuration, instead of the scenario's")
      ->excludes(sweep_seed);
  run_command->add_option("--controller", run.controller, controllers + ", instead of the configuration's");
  run_command->add_option("--log", run.log, "write every frame to this candump log");
  run_command
      ->add_option("--out", run.out,
                   "write candump.log, summary.json, drive.toml and report.html into this folder")
      ->excludes("--log");
  run_command->add_option("--record-qp", run.record_qp,
                          "write every quadratic problem of the controller into this folder, for bench qp");
  run_command->add_flag("--json", run.json, "summary as JSON");

  std::string log = "-";
  CLI::App* decode_command = app.add_subcommand("decode", "candump text to physical values");
  decode_command->add_option("LOG", log, "candump log; - for standard input")->capture_default_str();

  tools::BenchStepOptions bench;
  bench.scenario = Scenarios("whole_drive/scenario.toml");
  CLI::App* bench_command =
      app.add_subcommand("bench", "time parts of the controller")->require_subcommand(0, 1);
  CLI::App* step_command = bench_command->add_subcommand("step", "the whole control step along a drive");
  step_command->add_option("--scenario", bench.scenario, "scenario in TOML")->capture_default_str();
  step_command->add_option("--config", bench.config, "daemon's configuration, instead of the scenario's");
  step_command->add_option("--controller", bench.controller,
                           controllers + ", instead of the configuration's");
  step_command->add_option("--horizon", bench.horizons, "N, one or several")->capture_default_str();
  step_command->add_option("--repeat", bench.repeat, "drives per horizon")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  step_command->add_flag("--json", bench.json, "figures as JSON");
  tools::BenchQpOptions bench_qp;
  CLI::App* qp_command = bench_command->add_subcommand("qp", "the QP solver on recorded problems");
  qp_command->add_option("DIR", bench_qp.folder, "folder with problems *.qp; required");
  qp_command->add_option("--repeat", bench_qp.repeat, "solves of each problem")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  qp_command->add_flag("--json", bench_qp.json, "figures as JSON");

  const int processors = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  tools::PaperOptions paper;
  paper.scenarios = Scenarios("paper");
  paper.jobs = processors;
  CLI::App* paper_command =
      app.add_subcommand("paper", "the paper's comparisons, and whether its claims hold");
  paper_command->add_option("--out", paper.out,
                            "write report.html, report.json and paper.json into this folder");
  paper_command->add_flag("--map", paper.map,
                          "sweep speed, sideways shift and horizon too: hundreds of drives");
  paper_command->add_option("--jobs", paper.jobs, "processes that drive the map")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  paper_command->add_option("--repeat", paper.repeat, "drives of which each step's least time counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  paper_command->add_option("--scenarios", paper.scenarios, "folder with its scenarios")
      ->capture_default_str();
  paper_command->add_flag("--json", paper.json, "all figures as JSON");

  tools::SweepOptions sweep;
  sweep.jobs = processors;
  sweep.setup.controllers = tools::SweepControllers();
  CLI::App* sweep_command =
      app.add_subcommand("sweep", "drive many scenarios drawn by chance")->require_subcommand(0, 1);
  sweep_command->add_option("--count", sweep.setup.count, "scenarios; required")
      ->check(CLI::Range(1, 1'000'000));
  sweep_command->add_option("--seed", sweep.setup.seed, "of the sweep; required")->check(kSeeds);
  AddRanges(*sweep_command, sweep.setup.ranges);
  sweep_command
      ->add_option("--controller", sweep.setup.controllers,
                   fmt::format("one or several of {}", fmt::join(tools::SweepControllers(), ", ")))
      ->default_str("all");
  sweep_command->add_option("--jobs", sweep.jobs, "processes that drive")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  sweep_command->add_option_function<std::string>(
      "--shard", [&sweep](const std::string& text) { sweep.shard = tools::ParseShard(text); },
      "i/n: drive the i-th of n parts alone and write it, for sweep merge");
  sweep_command->add_option(
      "--out", sweep.out,
      "write sweep.json, timing.json, report.json and report.html into this folder; with --shard, "
      "the part to this file");
  sweep_command->add_flag("--json", sweep.json, "all figures as JSON");

  tools::SweepMergeOptions merge;
  CLI::App* merge_command = sweep_command->add_subcommand("merge", "join the parts of a sweep");
  merge_command->add_option("FILE", merge.parts, "parts, as sweep --shard wrote them; required");
  merge_command->add_option("--out", merge.out,
                            "write sweep.json, timing.json, report.json and report.html into this folder");
  merge_command->add_flag("--json", merge.json, "all figures as JSON");

  tools::ReportOptions report;
  CLI::App* report_command = app.add_subcommand("report", "a page about a run, for any browser");
  report_command->add_option("RUN_DIR", report.run_dir, "folder of a drive or of lpvmpc paper; required");
  report_command->add_option("-o,--output", report.output, "HTML file to write; required");

  try {
    try {
      app.parse(argc, argv);
      if (app.get_subcommands().empty())
        throw CLI::RequiredError("a command: run, decode, bench, paper, sweep or report");
      if (bench_command->parsed() && bench_command->get_subcommands().empty())
        throw CLI::RequiredError("a command: bench step or bench qp");
      RequireOption(*qp_command, "DIR");
      if (!run.sweep_seed) RequireOption(*run_command, "--scenario");
      if (!merge_command->parsed()) {
        RequireOption(*sweep_command, "--count");
        RequireOption(*sweep_command, "--seed");
      }
      RequireOption(*merge_command, "FILE");
      RequireOption(*report_command, "RUN_DIR");
      RequireOption(*report_command, "--output");
    } catch (const CLI::ParseError& error) {
      return error.get_exit_code() == 0 ? Finish(app.exit(error)) : Fail(error);
    }
    if (run_command->parsed()) return Finish(tools::Run(run, std::cout));
    if (decode_command->parsed()) return Decode(log);
    if (merge_command->parsed()) {
      tools::MergeSweep(merge, std::cout);
      return Finish(0);
    }
    if (sweep_command->parsed()) {
      tools::Sweep(sweep, std::cout);
      return Finish(0);
    }
    if (paper_command->parsed()) return Finish(tools::Paper(paper, std::cout));
    if (report_command->parsed()) {
      tools::Report(report);
      return 0;
    }
    if (qp_command->parsed()) {
      tools::BenchQp(bench_qp, std::cout);
    } else {
      tools::BenchStep(bench, std::cout);
    }
    return Finish(0);
  } catch (const std::exception& error) {
    return Fail(error);
  }
}
