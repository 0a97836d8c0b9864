"""The manual pages say what the programs and loop/config.hpp say.

usage: man_pages_test.py SOURCE_FOLDER FOLDER_OF_PROGRAMS
"""

import pathlib
import re
import subprocess
import sys
import unittest

SOURCE, PROGRAMS = (pathlib.Path(folder) for folder in sys.argv[1:])
COMMANDS = [("lpvmpcd", ""), ("lpvmpc-sim", "")]
COMMANDS += [
    ("lpvmpc", command)
    for command in ("", "run", "decode", "bench", "bench step", "paper", "sweep", "sweep merge", "report")
]
PAGES = {"lpvmpcd": "lpvmpcd.8", "lpvmpc-sim": "lpvmpc-sim.8", "lpvmpc": "lpvmpc.1"}


def sections(page):
    """The page's source by its headings."""
    parts = re.split(r"^# (.*)\n", (SOURCE / f"docs/man/{page}.scd").read_text(), flags=re.M)
    return dict(zip(parts[1::2], parts[2::2]))


def documented(text):
    """The entries of a section by their names: what stands behind the name, and the text below."""
    found = {}
    for head, body in re.findall(r"^(\*.*)\n((?:\t.*\n?)+)", text, flags=re.M):
        for name in re.findall(r"\*([^*]+)\*", head):
            found[name] = (head.rsplit("*", 1)[1], body)
    return found


def help_of(program, command):
    text = subprocess.run([PROGRAMS / program, *command.split(), "--help"], check=True, capture_output=True, text=True)
    return text.stdout


def listing():
    """Keys of loop/config.hpp by section: default and range, each None where the line has none."""
    keys, section = {}, None
    for line in (SOURCE / "loop/config.hpp").read_text().split("#pragma once")[0].splitlines():
        match = re.match(r"//   (?:\[(\w+)\] *| {14})([A-Za-z_].*)$", line)
        if not match:
            continue
        section = match[1] or section
        head = re.split(r" = |  +", match[2])[0]
        if not re.fullmatch(r"\w+(, \w+)*", head):
            raise ValueError(f"loop/config.hpp: no key of the listing: {line}")
        default = re.search(r" = (\[.*?\]|\S+( \w+)?)", match[2])
        limits = re.search(r"\S+\.\.[\w.-]*\w", match[2])
        for key in head.split(", "):
            keys.setdefault(section, {})[key] = (default and default[1], limits and limits[0])
    return keys


class ManPages(unittest.TestCase):
    def test_every_option_of_help_is_on_the_page_and_no_other(self):
        for program, command in COMMANDS:
            with self.subTest(program=program, command=command):
                text = help_of(program, command)
                told = set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", text, flags=re.M)) - {"--help"}
                page = sections(PAGES[program])
                if command == "bench":
                    self.assertEqual(told, set())
                    continue
                heading = {"lpvmpc": f"LPVMPC {command}".strip().upper()}.get(program, "OPTIONS")
                heading = "DESCRIPTION" if heading == "LPVMPC" else heading
                names = set(documented(page[heading])) - {"--help", "-h"}
                self.assertEqual({name for name in names if name.startswith("--")}, told)

    def test_every_command_of_help_has_its_section(self):
        told = re.findall(r"^  ([a-z]+) ", help_of("lpvmpc", "").split("Subcommands:")[1], flags=re.M)
        headings = [heading.split()[1].lower() for heading in sections("lpvmpc.1") if heading.startswith("LPVMPC ")]
        self.assertEqual(list(dict.fromkeys(headings)), told)

    def test_every_key_of_the_configuration_is_on_the_page_with_its_default_and_range(self):
        page = {
            heading.strip("[]"): documented(text)
            for heading, text in sections("lpvmpcd.toml.5").items()
            if heading.startswith("[")
        }
        keys = listing()
        self.assertGreater(sum(map(len, keys.values())), 30)
        self.assertEqual(list(page), list(keys))
        for section, wanted in keys.items():
            self.assertEqual(sorted(page[section]), sorted(wanted), section)
            for key, (default, limits) in wanted.items():
                with self.subTest(section=section, key=key):
                    head, body = page[section][key]
                    self.assertEqual(head.strip(" ="), default or "")
                    if limits:
                        self.assertRegex(body, rf"(^|\s){re.escape(limits)}[.,]")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
