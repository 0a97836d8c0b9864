"""scripts/layers accepts the tree as it is, and refuses what it shall. usage: layers_test.py PATH_OF_LAYERS"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

LAYERS = sys.argv[1]


def run(*arguments):
    return subprocess.run([LAYERS, *arguments], capture_output=True, text=True)


class Layers(unittest.TestCase):
    def tree(self, files):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        for name, text in files.items():
            path = pathlib.Path(folder.name, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return folder.name

    def assert_refused(self, files, message):
        result = run("--root", self.tree(files))
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn(message, result.stderr)

    def test_the_tree_keeps_to_its_arrows_and_the_graph_is_printed(self):
        result = run()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"floor +\d+ +loop ")
        self.assertIn("no circle, no arrow upwards", result.stdout)

    def test_an_include_upwards_is_refused_with_file_and_target(self):
        self.assert_refused({"scripts/layers.txt": "low:\nhigh: low\n",
                             "low/a.hpp": '#include "high/b.hpp"\n',
                             "high/b.hpp": "", "high/c.hpp": '#include "low/d.hpp"\n', "low/d.hpp": ""},
                            "low/a.hpp: includes high/b.hpp, but low may use nothing")

    def test_a_room_without_a_declaration_is_refused(self):
        self.assert_refused({"scripts/layers.txt": "low:\n", "low/a.hpp": "", "new/b.hpp": ""},
                            "new/b.hpp: room new is not declared")

    def test_a_nested_room_is_not_its_parent(self):
        self.assert_refused({"scripts/layers.txt": "low:\nlow/inner:\n", "low/a.hpp": '#include "low/inner/b.hpp"\n',
                             "low/inner/b.hpp": ""}, "low/a.hpp: includes low/inner/b.hpp")

    def test_an_arrow_that_nobody_uses_is_refused(self):
        self.assert_refused({"scripts/layers.txt": "low:\nhigh: low\n", "low/a.hpp": "", "high/b.hpp": ""},
                            "high does not use low")

    def test_a_circle_of_rooms_is_refused(self):
        self.assert_refused({"scripts/layers.txt": "one: two\ntwo: one\n", "one/a.hpp": '#include "two/b.hpp"\n',
                             "two/b.hpp": "", "two/c.hpp": '#include "one/d.hpp"\n', "one/d.hpp": ""},
                            "circle of rooms: ")

    def test_a_circle_of_files_in_one_room_is_refused(self):
        self.assert_refused({"scripts/layers.txt": "one:\n", "one/a.hpp": '#include "one/b.hpp"\n',
                             "one/b.hpp": '#include "one/a.hpp"\n'}, "circle of files: ")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
