"""scripts/mutate finds what it shall and can fail. usage: mutate_test.py PATH_OF_MUTATE BUILD_DIR"""
import importlib.machinery
import importlib.util
import subprocess
import sys
import unittest

MUTATE, BUILD = sys.argv[1:3]
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("mutate", MUTATE)
mutate = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutate", loader))
loader.exec_module(mutate)


def changed(text):
    """Every mutant of the text."""
    return {text[:m.start] + m.text + text[m.end:] for m in mutate.mutants("a.cpp", text)}


class Mutants(unittest.TestCase):
    def test_each_comparison_is_moved_by_one_and_turned_round(self):
        self.assertEqual(changed("a < b"), {"a <= b", "a >= b"})
        self.assertEqual(changed("a >= b"), {"a > b", "a < b"})
        self.assertEqual(changed("a == b"), {"a != b"})

    def test_logical_and_arithmetic_operators_become_others(self):
        self.assertEqual(changed("a && b || !c"), {"a || b || !c", "a && b && !c", "a && b || c"})
        self.assertEqual(changed("a + b * -c"), {"a - b * -c", "a + b / -c", "a + b * c"})
        self.assertEqual(changed("++i"), {"--i"})

    def test_constants_become_their_neighbours(self):
        self.assertEqual(changed("f(0, 7, 1.5, true)"), {"f(1, 7, 1.5, true)", "f(0, 8, 1.5, true)", "f(0, 6, 1.5, true)",
                                                         "f(0, 7, 2.5, true)", "f(0, 7, 1.5, false)"})
        self.assertEqual(changed("x = Mode::kInit;"),
                         {"x = static_cast<std::decay_t<decltype(Mode::kInit)>>(static_cast<int>(Mode::kInit) + 1);"})

    def test_conditions_are_negated(self):
        self.assertEqual(changed("if (f(a)) g();"), {"if (!(f(a))) g();"})
        self.assertEqual(changed("a ? b : c"), {"a == false ? b : c"})

    def test_another_value_is_returned(self):
        self.assertEqual(changed("return f(a);"), {"return {};", "return !(f(a));"})
        self.assertEqual(changed("std::optional<Fault> F() {\n  return std::nullopt;\n}"),
                         {"std::optional<Fault> F() {\n  return Fault{};\n}"})

    def test_what_is_no_code_and_no_operator_stays(self):
        self.assertEqual(changed('#include <a>\nstd::vector<int>* a; // 1 < 2\nF("1 < 2 \\" 3", &&b, c->d);'), set())


class Survivors(unittest.TestCase):
    def test_weak_tests_leave_survivors_and_fail(self):
        source = "safety/command_limiter.cpp"
        run = subprocess.run([MUTATE, "--build", BUILD, "--tests", "CommandLimiter.CommandWithinAllLimits*", source],
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertRegex(run.stdout, f"{source}:[0-9]+: survived\n  - .*age > limits_.max_age.*\n"
                                     r"  \+ .*age >= limits_.max_age")
        self.assertRegex(run.stdout, r"\n[0-9]+ died, [0-9]+ did not compile, [0-9]+ survived\n$")
        self.assertNotIn("- if (age < 0 || age > limits_.max_age) return {.status = LimitStatus::kTooOld};\n"
                         "  + if (age <= 0", run.stdout, "this one dies: the command that shall pass has age 0")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
