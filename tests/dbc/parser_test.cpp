#include "dbc/parser.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>

#include "dbc/codec.hpp"

namespace {

using dbc::Parse;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::string ErrorOf(const std::string& text) {
  try {
    static_cast<void>(Parse(text, "a.dbc"));
  } catch (const dbc::DbcError& error) {
    return error.what();
  }
  return "no error";
}

// A file with one message of eight bytes and these signals.
std::string WithSignals(const std::string& signals) {
  return "BO_ 100 M: 8 Node\n" + signals;
}

const dbc::Signal& Only(const dbc::Database& database) {
  return database.messages.at(0).signals.at(0);
}

TEST(Parser, KeepsEverythingThatAFileSays) {
  const dbc::Database database = Parse(R"(VERSION "2.1"
NS_ :
  NS_DESC_
  CM_
  VAL_TABLE_
BS_:
BU_: Engine Gateway
VAL_TABLE_ OnOff 1 "On" 0 "Off" ;
BO_ 100 Status: 8 Engine
 SG_ Speed : 7|16@0- (0.01,-40) [-40|615.35] "km/h"  Gateway,Vector__XXX
 SG_ Switch : 16|2@1+ (1,0) [0|3] "" Gateway
BO_ 2566834709 Long: 3 Vector__XXX
CM_ "the network";
CM_ BU_ Engine "a node";
CM_ BO_ 100 "a message";
CM_ SG_ 100 Speed "a signal";
BA_DEF_ "BusType" STRING ;
BA_DEF_ BO_ "Cycle" INT 0 1000;
BA_DEF_ SG_ "Kind" ENUM "raw","filtered";
BA_DEF_ BU_ "Weight" FLOAT 0 1e3;
BA_DEF_DEF_ "Cycle" 20;
BA_DEF_DEF_ "BusType" "CAN";
BA_ "BusType" "CAN FD";
BA_ "Cycle" BO_ 100 50;
BA_ "Kind" SG_ 100 Speed 1;
BA_ "Weight" BU_ Engine 2;
VAL_ 100 Switch 0 "Off" 1 "On" 3 "Not available" ;
)",
                                       "a.dbc");
  EXPECT_TRUE(database.warnings.empty());
  EXPECT_EQ(database.version, "2.1");
  EXPECT_EQ(database.comment, "the network");
  ASSERT_EQ(database.nodes.size(), 2u);
  EXPECT_EQ(database.nodes[0].comment, "a node");
  EXPECT_EQ(std::get<double>(database.nodes[0].attributes.at("Weight")), 2.0);
  EXPECT_EQ(database.value_tables.at("OnOff").at(1), "On");
  EXPECT_EQ(std::get<std::string>(database.attributes.at("BusType")), "CAN FD");
  EXPECT_EQ(std::get<std::string>(*database.attribute_definitions.at("BusType").default_value), "CAN");

  const dbc::MessageDefinition& status = *database.Find("Status");
  EXPECT_EQ(status.id, 100u);
  EXPECT_FALSE(status.extended);
  EXPECT_EQ(status.transmitter, "Engine");
  EXPECT_EQ(status.comment, "a message");
  EXPECT_EQ(dbc::Number(*database.Attribute(status, "Cycle")), 50.0);
  const dbc::Signal& speed = *status.Find("Speed");
  EXPECT_EQ(speed.byte_order, dbc::ByteOrder::kMotorola);
  EXPECT_EQ(speed.type, dbc::ValueType::kSigned);
  EXPECT_EQ(speed.start_bit, 7u);
  EXPECT_EQ(speed.length, 16u);
  EXPECT_EQ(speed.factor, 0.01);
  EXPECT_EQ(speed.offset, -40.0);
  EXPECT_EQ(speed.min, -40.0);
  EXPECT_EQ(speed.max, 615.35);
  EXPECT_EQ(speed.unit, "km/h");
  EXPECT_THAT(speed.receivers, ElementsAre("Gateway", "Vector__XXX"));
  EXPECT_EQ(speed.comment, "a signal");
  EXPECT_EQ(std::get<std::string>(speed.attributes.at("Kind")), "filtered");
  EXPECT_EQ(status.Find("Switch")->values.at(3), "Not available");

  const dbc::MessageDefinition& extended = *database.Find("Long");
  EXPECT_TRUE(extended.extended);
  EXPECT_EQ(extended.id, 2566834709u & 0x1FFFFFFFu);
  EXPECT_EQ(database.Find(extended.id, true), &extended);
  EXPECT_EQ(database.Find(extended.id, false), nullptr);
  EXPECT_EQ(dbc::Number(*database.Attribute(extended, "Cycle")), 20.0);
}

TEST(Parser, FloatsAreDeclaredBySigValtype) {
  const dbc::Database database = Parse(
      "BO_ 1 M: 8 N\n SG_ F : 0|32@1- (1,0) [0|0] \"\" N\nBO_ 2 O: 8 N\n SG_ D : 0|64@1- (1,0) [0|0] \"\" N\n"
      "SIG_VALTYPE_ 1 F : 1;\nSIG_VALTYPE_ 2 D :2;\n",
      "a.dbc");
  EXPECT_EQ(database.messages[0].signals[0].type, dbc::ValueType::kFloat32);
  EXPECT_EQ(database.messages[1].signals[0].type, dbc::ValueType::kFloat64);
}

TEST(Parser, SimpleMultiplexingTellsWhichSignalsArePresent) {
  const dbc::Database database = Parse(WithSignals(" SG_ Page M : 0|8@1+ (1,0) [0|0] \"\" N\n"
                                                   " SG_ A m0 : 8|8@1+ (1,0) [0|0] \"\" N\n"
                                                   " SG_ B m7 : 8|8@1+ (1,0) [0|0] \"\" N\n"
                                                   " SG_ C : 16|8@1+ (1,0) [0|0] \"\" N\n"),
                                       "a.dbc");
  const dbc::MessageDefinition& message = database.messages.at(0);
  std::array<std::byte, 8> payload{std::byte{7}};
  EXPECT_TRUE(message.Find("Page")->is_multiplexor);
  EXPECT_TRUE(dbc::IsPresent(message, *message.Find("Page"), payload));
  EXPECT_FALSE(dbc::IsPresent(message, *message.Find("A"), payload));
  EXPECT_TRUE(dbc::IsPresent(message, *message.Find("B"), payload));
  EXPECT_TRUE(dbc::IsPresent(message, *message.Find("C"), payload));
}

TEST(Parser, ExtendedMultiplexingTellsWhichSignalsArePresent) {
  const dbc::Database database = Parse(WithSignals(" SG_ Outer M : 0|8@1+ (1,0) [0|0] \"\" N\n"
                                                   " SG_ Inner m1M : 8|8@1+ (1,0) [0|0] \"\" N\n"
                                                   " SG_ Deep m0 : 16|8@1+ (1,0) [0|0] \"\" N\n"
                                                   "SG_MUL_VAL_ 100 Inner Outer 1-1;\n"
                                                   "SG_MUL_VAL_ 100 Deep Inner 0-2, 5-5;\n"),
                                       "a.dbc");
  const dbc::MessageDefinition& message = database.messages.at(0);
  const dbc::Signal& deep = *message.Find("Deep");
  const auto present = [&](unsigned outer, unsigned inner) {
    const std::array<std::byte, 8> payload{static_cast<std::byte>(outer), static_cast<std::byte>(inner)};
    return dbc::IsPresent(message, deep, payload);
  };
  EXPECT_TRUE(present(1, 2));
  EXPECT_TRUE(present(1, 5));
  EXPECT_FALSE(present(1, 3));
  EXPECT_FALSE(present(0, 2));  // Inner itself is absent
}

TEST(Parser, RealFilesAreRead) {
  // No VERSION, NS_, BS_, BU_; Windows line ends; a byte order mark.
  EXPECT_EQ(Parse("\xEF\xBB\xBF"
                  "BO_ 1 M: 8 N\r\n SG_ A : 0|8@1+ (1,0) [0|0] \"\" N\r\n",
                  "a.dbc")
                .messages.size(),
            1u);
  EXPECT_TRUE(Parse("", "a.dbc").messages.empty());
  // Comments with quotes and line breaks; text in cp1252.
  EXPECT_EQ(Parse("CM_ \"say \\\"no\\\"\nand go\";", "a.dbc").comment, "say \"no\"\nand go");
  EXPECT_EQ(Only(Parse(WithSignals("SG_ A : 0|8@1+ (1,0) [0|0] \"\xB0"
                                   "C\" N"),
                       "a.dbc"))
                .unit,
            "\xB0"
            "C");
  EXPECT_EQ(Parse("CM_ \"IMPORT other.dbc\";", "a.dbc").comment, "IMPORT other.dbc");
  // No blanks, many blanks, no receivers, receivers without commas, exponents, explicit signs.
  EXPECT_EQ(Only(Parse(WithSignals("SG_ A:0|8@1-(1E-3,+2.5)[-1e2|+3]\"\"N"), "a.dbc")).offset, 2.5);
  EXPECT_EQ(Only(Parse(WithSignals("SG_ A  :  0 | 8 @ 1 + ( .5 , 0 ) [ 0 | 1. ] \"\"\nCM_ \"x\";"), "a.dbc"))
                .factor,
            0.5);
  EXPECT_THAT(Only(Parse(WithSignals("SG_ A : 0|8@1+ (1,0) [0|0] \"\" N O P"), "a.dbc")).receivers,
              ElementsAre("N", "O", "P"));
  // Ranges that do not count as such.
  EXPECT_FALSE(Only(Parse(WithSignals("SG_ A : 0|8@1+ (1,0) [0|0] \"\" N"), "a.dbc")).HasRange());
  EXPECT_FALSE(Only(Parse(WithSignals("SG_ A : 0|8@1+ (1,0) [5|-5] \"\" N"), "a.dbc")).HasRange());
  // DLC 0 and above 8.
  EXPECT_EQ(
      Parse("BO_ 1 M: 0 N\nBO_ 2 F: 64 N\n SG_ A : 504|8@1+ (1,0) [0|0] \"\" N", "a.dbc").messages[1].length,
      64u);
  // Signals that belong to no message may overlap and be anywhere.
  const dbc::Database independent = Parse(
      "BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX\n SG_ A : 0|8@1+ (1,0) [0|0] \"\" N\n"
      " SG_ A : 0|8@1+ (1,0) [0|0] \"\" N\nCM_ SG_ 3221225472 A \"x\";",
      "a.dbc");
  EXPECT_TRUE(independent.messages.empty());
  EXPECT_TRUE(independent.warnings.empty());
}

TEST(Parser, StatementsOfNoUseHereAreSkipped) {
  const dbc::Database database = Parse(R"(BU_:
BO_ 1 M: 8 N
 SG_ A : 0|8@1+ (1,0) [0|0] "" N
BO_TX_BU_ 1 : N,O;
EV_ Env: 0 [0|1] "" 0 2 DUMMY_NODE_VECTOR0 Vector__XXX;
ENVVAR_DATA_ Env: 5;
SIG_GROUP_ 1 Group 1 : A;
BA_DEF_REL_ BU_SG_REL_ "Timeout; of a signal" INT 0 1;
BA_REL_ "Timeout" BU_SG_REL_ N SG_ 1 A 3;
BA_DEF_SGTYPE_ "x" INT 0 1;
VAL_ Env 0 "a" 1 "b";
SOME_FUTURE_ a b c { % } ;
CM_ EV_ Env "x";
BO_ 2 O: 8 N
)",
                                       "a.dbc");
  EXPECT_EQ(database.messages.size(), 2u);
  EXPECT_TRUE(database.warnings.empty());
}

TEST(Parser, ValueTablesHoldNegativeAndLargestValues) {
  const dbc::Database database = Parse(
      WithSignals(
          "SG_ A : 0|64@1- (1,0) [0|0] \"\" N\nVAL_TABLE_ T -9223372036854775808 \"low\" -1 \"minus\" ;\n"
          "VAL_ 100 A 18446744073709551615 \"all\" -2 \"two\" 3.0 \"three\";"),
      "a.dbc");
  EXPECT_EQ(database.value_tables.at("T").begin()->second, "low");
  EXPECT_EQ(Only(database).values.at(-1), "all");
  EXPECT_EQ(Only(database).values.at(-2), "two");
  EXPECT_EQ(Only(database).values.at(3), "three");
}

TEST(Parser, HarmlessOdditiesAreWarnings) {
  const auto warning = [](const std::string& text) {
    const dbc::Database database = Parse(text, "a.dbc");
    return database.warnings.empty() ? "no warning" : database.warnings.front();
  };
  EXPECT_EQ(warning("CM_ BO_ 7 \"x\";"), "a.dbc:1:9: there is no message with id 7");
  EXPECT_EQ(warning("BO_ 7 M: 8 N\nVAL_ 7 A 0 \"x\";"), "a.dbc:2:8: message M has no signal A");
  EXPECT_THAT(warning("CM_ BU_ N \"x\";"), HasSubstr("no node N"));
  EXPECT_THAT(warning("BA_ \"Cycle\" 3;"), HasSubstr("no definition of attribute \"Cycle\""));
  EXPECT_THAT(warning("BO_ 2048 M: 8 N"), HasSubstr("more than 11 bits"));
  EXPECT_THAT(warning("BO_ 1 M: 8 N\nBO_ 2 M: 8 N"), HasSubstr("message name M is given twice"));
}

TEST(Parser, SyntaxErrorsTellPlaceAndWhatWasExpected) {
  EXPECT_EQ(ErrorOf("BO_ 100 M 8 N"), "a.dbc:1:11: found '8', expected ':' after the message name");
  EXPECT_EQ(ErrorOf("\n\n  nonsense"),
            "a.dbc:3:3: found 'nonsense', expected a statement such as BO_, SG_ or CM_");
  EXPECT_EQ(ErrorOf("BO_ x M: 8 N"),
            "a.dbc:1:5: found 'x', expected a message id, an integer from 0 to 4294967295");
  EXPECT_EQ(ErrorOf("CM_ \"no end;\n"), "a.dbc:1:5: found a string without its closing '\"'");
  EXPECT_EQ(ErrorOf("CM_ \"x\""), "a.dbc:1:8: found the end of the file, expected ';' after the comment");
  EXPECT_EQ(ErrorOf("BO_TX_BU_ 1 : N"),
            "a.dbc:1:1: found 'BO_TX_BU_' without a ';' up to the end of the file");
  EXPECT_EQ(ErrorOf("\x01"), "a.dbc:1:1: found '\\x01', expected a statement such as BO_, SG_ or CM_");
  EXPECT_EQ(
      ErrorOf(WithSignals("SG_ A : 0|8@2+ (1,0) [0|0] \"\" N")),
      "a.dbc:2:13: found '2', expected the byte order, 0 = Motorola or 1 = Intel, an integer from 0 to 1");
  EXPECT_EQ(ErrorOf(WithSignals("SG_ A : 0|8@1 (1,0) [0|0] \"\" N")),
            "a.dbc:2:15: found '(', expected '+' (unsigned) or '-' (signed) after the byte order");
  EXPECT_EQ(ErrorOf(WithSignals("SG_ A : 0|8@1+ (one,0) [0|0] \"\" N")),
            "a.dbc:2:17: found 'one', expected the factor, a number");
  EXPECT_EQ(ErrorOf(WithSignals("SG_ A : 0|8@1+ (1e999,0) [0|0] \"\" N")),
            "a.dbc:2:17: found '1e999', expected the factor, a number");
  EXPECT_THAT(ErrorOf(WithSignals("SG_ A x3 : 0|8@1+ (1,0) [0|0] \"\" N")),
              StartsWith("a.dbc:2:7: found 'x3'"));
  EXPECT_THAT(ErrorOf("SG_ A : 0|8@1+ (1,0) [0|0] \"\" N"), HasSubstr("expected BO_"));
  EXPECT_THAT(ErrorOf("BO_ 1 M: 8\nSG_ A : 0|8@1+ (1,0) [0|0] \"\" N"),
              StartsWith("a.dbc:2:1: found 'SG_', expected the transmitter"));
}

TEST(Parser, SemanticErrorsTellPlaceAndValue) {
  const std::string tail = "@1+ (1,0) [0|0] \"\" N\n";
  EXPECT_EQ(ErrorOf("BO_ 1 M: 8 N\nBO_ 1 O: 8 N\n"), "a.dbc:2:5: message id 1 of O is already that of M");
  EXPECT_EQ(ErrorOf(WithSignals("SG_ A : 0|8" + tail + "SG_ A : 8|8" + tail)),
            "a.dbc:3:5: signal A is given twice in message M");
  EXPECT_EQ(ErrorOf(WithSignals("SG_ A : 60|8" + tail)),
            "a.dbc:2:5: signal A (start bit 60, 8 bits) is outside message M of 8 bytes");
  EXPECT_EQ(ErrorOf(WithSignals("SG_ A : 56|9@0+ (1,0) [0|0] \"\" N\n")),
            "a.dbc:2:5: signal A (start bit 56, 9 bits) is outside message M of 8 bytes");
  EXPECT_EQ(ErrorOf(WithSignals("SG_ A : 0|0" + tail)), "a.dbc:2:11: signal A has 0 bits, expected 1 to 64");
  EXPECT_EQ(ErrorOf(WithSignals("SG_ A : 0|65" + tail)),
            "a.dbc:2:11: signal A has 65 bits, expected 1 to 64");
  EXPECT_EQ(ErrorOf(WithSignals("SG_ A : 0|8@1+ (0.0,0) [0|0] \"\" N\n")),
            "a.dbc:2:17: signal A has the factor 0, expected any other");
  EXPECT_EQ(ErrorOf(WithSignals("SG_ A : 0|16" + tail + "SIG_VALTYPE_ 100 A : 1;")),
            "a.dbc:3:22: signal A is a float of 16 bits, expected 32");
  EXPECT_EQ(ErrorOf(WithSignals("SG_ A m0 : 0|8" + tail)),
            "a.dbc:2:5: signal A is multiplexed, but message M has 0 multiplexors, expected 1");
  EXPECT_EQ(ErrorOf(WithSignals("SG_ A : 0|8" + tail + "SG_MUL_VAL_ 100 A B 0-0;")),
            "a.dbc:2:5: signal A is multiplexed by B, which is not in message M");
  EXPECT_EQ(ErrorOf(WithSignals("SG_ A : 0|8" + tail + "SG_MUL_VAL_ 100 A A 0-0;")),
            "a.dbc:2:5: the multiplexors of signal A are circular");
  EXPECT_THAT(ErrorOf("BO_ 4294967295 M: 8 N"), HasSubstr("has more than 29 bits"));
}

}  // namespace
