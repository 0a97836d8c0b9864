// Damaged text: Parse either returns a database that can be used or throws DbcError.
#include <array>
#include <gtest/gtest.h>
#include <random>
#include <string>

#include "bus/vehicle_bus.hpp"
#include "dbc/codec.hpp"
#include "dbc/parser.hpp"

namespace {

std::string Mutate(std::string text, std::mt19937& random) {
  static constexpr std::array<std::string_view, 26> kPieces{"\"",
                                                            ";",
                                                            ":",
                                                            "|",
                                                            "@",
                                                            "(",
                                                            "-",
                                                            "0",
                                                            "64",
                                                            "4294967295",
                                                            "18446744073709551615",
                                                            "1e999",
                                                            "0x1",
                                                            "\\\"",
                                                            "\n",
                                                            "\xFF",
                                                            "M ",
                                                            "m0M ",
                                                            " m ",
                                                            "SG_ ",
                                                            "BO_ ",
                                                            "VAL_ ",
                                                            "SG_MUL_VAL_ 288 Part Part 0-3;",
                                                            "SIG_VALTYPE_ 256 X : 1;",
                                                            "BA_ ",
                                                            "NS_ :"};
  const auto below = [&](std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
  };
  for (std::size_t change = 1 + below(4); change > 0; --change) {
    const std::size_t at = below(text.size());
    const std::size_t length = 1 + below(12);
    switch (below(5)) {
      case 0:
        text[at] = static_cast<char>(below(256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, kPieces.at(below(kPieces.size())));
        break;
      case 3:
        text.insert(below(text.size()), text.substr(at, 20 * length));
        break;
      default:
        if (below(8) == 0) text.resize(at + 1);
        break;
    }
  }
  return text;
}

void Use(const dbc::Database& database) {
  std::array<std::byte, dbc::kMaxMessageLength> payload;
  payload.fill(std::byte{0x5A});
  for (const dbc::MessageDefinition& message : database.messages) {
    const std::span whole = std::span(payload).first(message.length);
    for (const dbc::Signal& signal : message.signals) {
      ASSERT_TRUE(dbc::Fits(signal, message.length));
      static_cast<void>(dbc::IsPresent(message, signal, whole));
      static_cast<void>(dbc::ValueText(signal, whole));
      static_cast<void>(dbc::EncodeSignal(signal, 1e6 * dbc::DecodeSignal(signal, whole), whole));
    }
  }
}

TEST(ParserFuzz, DamagedTextIsReadOrRefused) {
  std::mt19937 random(20);
  const std::string original(bus::BuiltInDbc());
  int read = 0;
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::string text = Mutate(original, random);
    try {
      Use(dbc::Parse(text, "mutant.dbc"));
      ++read;
    } catch (const dbc::DbcError& error) {
      const std::string what = error.what();
      ASSERT_TRUE(what.starts_with("mutant.dbc:")) << what;
      ASSERT_EQ(what.find('\n'), std::string::npos) << what;
      ++refused;
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 1000);
}

TEST(ParserFuzz, EveryBeginningOfTheFileIsReadOrRefused) {
  const std::string original(bus::BuiltInDbc());
  for (std::size_t length = 0; length < original.size(); length += 7) {
    try {
      Use(dbc::Parse(std::string_view(original).substr(0, length), "beginning.dbc"));
    } catch (const dbc::DbcError&) {
    }
  }
}

}  // namespace
