#include "config/toml_table.hpp"

#include <functional>
#include <string>

#include "config/edit_distance.hpp"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace config {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TomlTable Parse(const std::string& text) {
  return TomlTable::Parse(text, "folder/a.toml");
}

std::string ErrorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "no error";
}

TEST(TomlTable, ReadsEveryTypeOfValue) {
  const TomlTable file = Parse("i = -3\nx = 0.5\nb = true\nt = \"word\"\na = [1, 2.5]\np = \"b.csv\"\n");
  EXPECT_EQ(file.Integer("i"), -3);
  EXPECT_EQ(file.Number("x"), 0.5);
  EXPECT_TRUE(file.Boolean("b"));
  EXPECT_EQ(file.Text("t"), "word");
  EXPECT_EQ(file.Choice("t", {"other", "word"}), 1u);
  EXPECT_THAT(file.Numbers("a", 2), ElementsAre(1.0, 2.5));
  EXPECT_EQ(file.Path("p"), "folder/b.csv");
}

TEST(TomlTable, ValuesAreAllThatIsWrittenByFullKey) {
  const TomlTable table =
      TomlTable::Parse("a = 1\n[b]\nc = [1, 2.5]\nd = \"x\"\n[b.e]\nf = true\n", "test.toml");
  const std::map<std::string, std::string> values = table.Values();
  ASSERT_EQ(values.size(), 4U);
  EXPECT_EQ(values.at("a"), "1");
  EXPECT_EQ(values.at("b.c"), "[ 1, 2.5 ]");
  EXPECT_NE(values.at("b.d"), "x");  // distinct from a bare value of the same text
  EXPECT_EQ(values.at("b.e.f"), "true");
  EXPECT_TRUE(table.Table("none").Values().empty());
}

TEST(TomlTable, IntegerIsAcceptedAsNumber) {
  EXPECT_EQ(Parse("x = 3").Number("x"), 3.0);
}

TEST(TomlTable, AbsolutePathStays) {
  EXPECT_EQ(Parse("p = \"/x/y\"").Path("p"), "/x/y");
}

TEST(TomlTable, MissingKeyTakesTheFallback) {
  const TomlTable file = Parse("");
  EXPECT_EQ(file.NumberOr("x", 1.5), 1.5);
  EXPECT_EQ(file.IntegerOr("i", 7), 7);
  EXPECT_TRUE(file.BooleanOr("b", true));
  EXPECT_EQ(file.TextOr("t", "other"), "other");
  EXPECT_EQ(file.ChoiceOr("c", 1, {"a", "b"}), 1u);
  EXPECT_FALSE(file.Has("x"));
  EXPECT_TRUE(file.Tables("none").empty());
  EXPECT_EQ(file.Table("none").NumberOr("x", 2.0), 2.0);
}

TEST(TomlTable, PresentKeyIsCheckedEvenWithAFallback) {
  EXPECT_EQ(ErrorOf([] {
              (void)Parse("x = 9").NumberOr("x", 1.0, {0.0, 2.0});
            }),
            "folder/a.toml:1: key 'x' = 9 is outside [0, 2]");
}

TEST(TomlTable, ValueOutsideTheRangeNamesFileLineKeyValueAndRange) {
  const TomlTable file = Parse("\n[road]\nleft = -3\nright = 1.5e3\n");
  EXPECT_EQ(ErrorOf([&] {
              (void)file.Table("road").Number("left", {0.0, 100.0}, "m");
            }),
            "folder/a.toml:3: key 'road.left' = -3 is outside [0, 100] m");
  EXPECT_EQ(ErrorOf([&] { (void)file.Table("road").Number("right", {.max = 1.0}, "m"); }),
            "folder/a.toml:4: key 'road.right' = 1500 is outside (-inf, 1] m");
  EXPECT_EQ(ErrorOf([&] { (void)file.Table("road").Integer("left", {.min = 0}); }),
            "folder/a.toml:3: key 'road.left' = -3 is outside [0, 2147483647]");
}

TEST(TomlTable, WrongTypeNamesValueAndType) {
  const TomlTable file = Parse("x = \"abc\"\ni = 2.5\nb = 1\nt = [1]\na = [1, \"u\"]\n");
  EXPECT_EQ(ErrorOf([&] { (void)file.Number("x"); }),
            "folder/a.toml:1: key 'x' = \"abc\" (string) must be a number");
  EXPECT_EQ(ErrorOf([&] { (void)file.Integer("i"); }),
            "folder/a.toml:2: key 'i' = 2.5 (number) must be an integer");
  EXPECT_EQ(ErrorOf([&] { (void)file.Boolean("b"); }),
            "folder/a.toml:3: key 'b' = 1 (integer) must be true or false");
  EXPECT_EQ(ErrorOf([&] { (void)file.Text("t"); }), "folder/a.toml:4: key 't' (array) must be a string");
  EXPECT_EQ(ErrorOf([&] { (void)file.Numbers("a", 0); }),
            "folder/a.toml:5: key 'a[1]' = \"u\" (string) must be a number");
  EXPECT_EQ(ErrorOf([&] { (void)file.Numbers("a", 3); }),
            "folder/a.toml:5: key 'a' has 2 elements, must be an array of 3 numbers");
  EXPECT_EQ(ErrorOf([&] { (void)file.Table("i"); }),
            "folder/a.toml:2: key 'i' = 2.5 (number) must be a table");
  EXPECT_EQ(ErrorOf([&] { (void)file.Tables("a"); }),
            "folder/a.toml:5: key 'a[0]' = 1 (integer) must be a table");
}

TEST(TomlTable, UnknownChoiceNamesTheChoices) {
  EXPECT_EQ(ErrorOf([] {
              (void)Parse("t = \"up\"").Choice("t", {"left", "right"});
            }),
            "folder/a.toml:1: key 't' = \"up\" must be one of \"left\", \"right\"");
}

TEST(TomlTable, NumberThatIsNotFiniteIsRefused) {
  EXPECT_EQ(ErrorOf([] { (void)Parse("x = nan").Number("x"); }),
            "folder/a.toml:1: key 'x' = nan is not a finite number");
  EXPECT_EQ(ErrorOf([] { (void)Parse("x = -inf").Number("x"); }),
            "folder/a.toml:1: key 'x' = -inf is not a finite number");
}

TEST(TomlTable, IntegerBeyondIntIsRefused) {
  EXPECT_THAT(ErrorOf([] { (void)Parse("i = 3000000000").Integer("i"); }),
              StartsWith("folder/a.toml:1: key 'i' = 3000000000 is outside "));
}

TEST(TomlTable, MissingKeyNamesWhatIsWanted) {
  const TomlTable file = Parse("x = 1\n\n[a]\ny = 2\n");
  EXPECT_EQ(ErrorOf([&] {
              (void)file.Table("a").Number("b", {0.0, 1.0}, "s");
            }),
            "folder/a.toml:3: key 'a.b' is missing (a number in [0, 1] s)");
  EXPECT_EQ(ErrorOf([&] { (void)file.Table("c").Text("b"); }),
            "folder/a.toml:1: key 'c.b' is missing (a string)");
}

TEST(TomlTable, UnknownKeyIsRefusedWithASuggestion) {
  const TomlTable file = Parse("x = 1\n[road]\nlefft = 4\n");
  (void)file.Number("x");
  (void)file.Table("road").NumberOr("left", 3.0);
  EXPECT_EQ(ErrorOf([&] { file.RefuseUnknownKeys(); }),
            "folder/a.toml:3: unknown key 'road.lefft', is 'road.left' meant?");
}

TEST(TomlTable, FirstUnknownKeyInTheFileIsNamed) {
  const TomlTable file = Parse("z = 1\nabcdef = 2\n");
  EXPECT_EQ(ErrorOf([&] { file.RefuseUnknownKeys(); }), "folder/a.toml:1: unknown key 'z'");
}

TEST(TomlTable, UnknownKeyInAnArrayOfTablesIsRefused) {
  const TomlTable file = Parse("[[o]]\nx = 1\n[[o]]\nx = 2\nother = 3\n");
  for (const TomlTable& table : file.Tables("o")) (void)table.Number("x");
  EXPECT_EQ(ErrorOf([&] { file.RefuseUnknownKeys(); }), "folder/a.toml:5: unknown key 'o[1].other'");
}

TEST(TomlTable, KeysThatWereAskedForAreAccepted) {
  const TomlTable file = Parse("x = 1\n[a]\ny = 2\n[[o]]\nz = 3\n");
  (void)file.Number("x");
  (void)file.Table("a").Number("y");
  for (const TomlTable& table : file.Tables("o")) (void)table.Number("z");
  EXPECT_NO_THROW(file.RefuseUnknownKeys());
}

TEST(TomlTable, SyntaxErrorNamesTheLine) {
  EXPECT_THAT(ErrorOf([] { (void)Parse("x = 1\ny = = 2\n"); }), StartsWith("folder/a.toml:2: "));
  EXPECT_THAT(ErrorOf([] { (void)Parse("x = 1\nx = 2\n"); }), StartsWith("folder/a.toml:2: "));
}

TEST(TomlTable, FileThatCannotBeReadIsNamed) {
  EXPECT_EQ(ErrorOf([] { (void)TomlTable::Read("/nowhere/a.toml"); }),
            "/nowhere/a.toml: cannot be read: No such file or directory");
  EXPECT_EQ(ErrorOf([] { (void)TomlTable::Read("/tmp"); }), "/tmp: cannot be read: Is a directory");
}

TEST(TomlTable, EmptyFileIsAnEmptyTable) {
  EXPECT_NO_THROW(TomlTable::Read("/dev/null").RefuseUnknownKeys());
}

TEST(TomlTable, ErrorOfTheCallerNamesKeyAndValue) {
  const TomlTable file = Parse("a = 1\n[t]\nb = 2\n");
  EXPECT_STREQ(file.Table("t").Error("b", "is wrong").what(), "folder/a.toml:3: key 't.b' = 2 is wrong");
  EXPECT_STREQ(file.Table("t").Error("c", "is wrong").what(), "folder/a.toml:2: key 't.c' is wrong");
}

TEST(TomlTable, ErrorStaysOnOneLine) {
  EXPECT_THAT(ErrorOf([] { (void)Parse("x = \"a\\nb\"").Number("x"); }), HasSubstr("\"a?b\""));
  EXPECT_EQ(ErrorOf([] { (void)TomlTable::Read("/no\nwhere.toml"); }),
            "/no?where.toml: cannot be read: No such file or directory");
}

TEST(EditDistance, CountsInsertedRemovedAndReplacedCharacters) {
  EXPECT_EQ(EditDistance("left", "left"), 0u);
  EXPECT_EQ(EditDistance("lefft", "left"), 1u);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3u);
  EXPECT_EQ(EditDistance("", "abc"), 3u);
}

}  // namespace
}  // namespace config
