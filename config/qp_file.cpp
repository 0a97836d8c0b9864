#include "config/qp_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "config/text_file.hpp"

namespace config {
namespace {

using control::kNoBound;
using Qp = control::OcpQp<8, 2>;

constexpr int kNx = 8, kNu = 2;
constexpr int kMostSteps = 1000;
constexpr double kAbsent = 1e19;
constexpr std::string_view kSigma = "sigma";

// Splits a file into words and counts its lines.
class Words {
 public:
  explicit Words(const std::filesystem::path& file) : file_(file), text_(ReadTextFile(file)) {}

  // The next word; empty at the end of the file.
  std::string_view Next() {
    constexpr std::string_view kSpace = " \t\r\n";
    while (at_ < text_.size() && kSpace.find(text_[at_]) != std::string_view::npos)
      line_ += text_[at_++] == '\n' ? 1 : 0;
    const std::size_t begin = at_;
    at_ = std::min(text_.find_first_of(kSpace, at_), text_.size());
    return std::string_view(text_).substr(begin, at_ - begin);
  }
  double Number() { return ToNumber(Next()); }
  double ToNumber(std::string_view word) const {
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty()) Fail("ends too early");
    if (error != std::errc{} || end != word.data() + word.size() || std::isnan(value))
      Fail(fmt::format("{}: not a number", Printable(word)));
    return value;
  }
  int Whole(std::string_view word, const char* name, int least, int most) const {
    const double value = ToNumber(word);
    if (value != std::floor(value) || value < least || value > most)
      Fail(fmt::format("{} = {} must be a whole number in [{}, {}]", name, word, least, most));
    return static_cast<int>(value);
  }
  [[noreturn]] void Fail(const std::string& what) const {
    throw std::runtime_error(fmt::format("{}:{}: {}", PlaceName(file_), line_, what));
  }

 private:
  std::filesystem::path file_;
  std::string text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

// Reads numbers in sequence.
class Numbers {
 public:
  explicit Numbers(std::span<const double> numbers) : at_(numbers.data()) {}
  double One() { return *at_++; }
  template <typename Matrix>
  void Fill(Matrix& matrix) {
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
      for (Eigen::Index c = 0; c < matrix.cols(); ++c) matrix(r, c) = One();
    }
  }

 private:
  const double* at_;
};

}  // namespace

QpFile::QpFile(const std::filesystem::path& file) {
  Words words(file);
  std::string_view first = words.Next();
  sigma_ = first == kSigma;
  if (sigma_) first = words.Next();
  horizon_ = words.Whole(first, "N", 1, kMostSteps);
  static_cast<void>(words.Whole(words.Next(), "nx", kNx, kNx));
  static_cast<void>(words.Whole(words.Next(), "nu", kNu, kNu));
  const auto take = [&](int count) {
    for (int i = 0; i < count; ++i) numbers_.push_back(words.Number());
  };
  take(kNx + horizon_ * (kNx * kNx + kNx * kNu + kNx) + (horizon_ + 1) * 2 * kNx + horizon_ * 2 * kNu);
  for (int i = 0; i <= horizon_; ++i) {
    const int rows = words.Whole(words.Next(), "number of rows", 0, control::kMaxRows);
    numbers_.push_back(rows);
    take(rows * (kNx + kNu + (sigma_ ? 4 : 3)));
  }
  if (const std::string_view rest = words.Next(); !rest.empty())
    words.Fail(fmt::format("{}: nothing more was expected", Printable(rest)));
}

void QpFile::Build(Qp& qp) const {
  Numbers numbers(numbers_);
  const auto stages = std::span(qp.stages), inputs = stages.first(stages.size() - 1);
  numbers.Fill(qp.x0);
  for (auto& stage : inputs) {
    numbers.Fill(stage.A);
    numbers.Fill(stage.B);
    numbers.Fill(stage.c);
  }
  for (auto& stage : stages) {
    numbers.Fill(stage.Q);
    numbers.Fill(stage.q);
  }
  for (auto& stage : inputs) {
    numbers.Fill(stage.R);
    numbers.Fill(stage.r);
  }
  for (auto& stage : stages) {
    stage.ClearRows();
    for (int count = static_cast<int>(numbers.One()); count > 0; --count) {
      Eigen::Matrix<double, kNx, 1> C;
      Eigen::Matrix<double, kNu, 1> D;
      numbers.Fill(C);
      numbers.Fill(D);
      double lo = numbers.One(), hi = numbers.One();
      if (lo < -kAbsent) lo = -kNoBound;
      if (hi > kAbsent) hi = kNoBound;
      const double rho = numbers.One(), sigma = sigma_ ? numbers.One() : 0.0;
      static_cast<void>(stage.AddRow(C, D, lo, hi, rho, sigma));
    }
  }
}

Qp QpFile::Build() const {
  Qp qp(horizon_);
  Build(qp);
  return qp;
}

void WriteQpFile(const Qp& qp, std::ostream& out) {
  const auto stages = std::span(qp.stages), inputs = stages.first(stages.size() - 1);
  const auto rows_of = [](const auto& stage) {
    return std::span(stage.rows).first(static_cast<std::size_t>(stage.row_count));
  };
  const bool sigma = std::ranges::any_of(stages, [&](const auto& stage) {
    return std::ranges::any_of(rows_of(stage), [](const auto& row) { return row.sigma > 0.0; });
  });
  const auto write = [&out](const auto& matrix) {
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
      for (Eigen::Index c = 0; c < matrix.cols(); ++c) fmt::print(out, "{} ", matrix(r, c));
    }
    out << '\n';
  };
  fmt::print(out, "{}{} {} {}\n", sigma ? "sigma " : "", qp.horizon(), kNx, kNu);
  write(qp.x0);
  for (const auto& stage : inputs) {
    write(stage.A);
    write(stage.B);
    write(stage.c);
  }
  for (const auto& stage : stages) {
    write(stage.Q);
    write(stage.q);
  }
  for (const auto& stage : inputs) {
    write(stage.R);
    write(stage.r);
  }
  for (const auto& stage : stages) {
    fmt::print(out, "{}\n", stage.row_count);
    for (const auto& row : rows_of(stage)) {
      write(row.C);
      write(row.D);
      fmt::print(out, "{} {} {}", row.has_lo() ? row.lo : -10.0 * kAbsent,
                 row.has_hi() ? row.hi : 10.0 * kAbsent, row.rho);
      out << (sigma ? fmt::format(" {}\n", row.sigma) : "\n");
    }
  }
}

}  // namespace config
