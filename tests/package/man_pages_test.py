"""The manual pages say what the programs do: options and commands of --help, keys, defaults and ranges of --check-config.

usage: man_pages_test.py SOURCE_FOLDER FOLDER_OF_PROGRAMS FOLDER_OF_GENERATED_PAGES
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE, PROGRAMS, GENERATED = (pathlib.Path(folder) for folder in sys.argv[1:])
COMMANDS = [("lpvmpcd", ""), ("lpvmpc-sim", "")]
COMMANDS += [
    ("lpvmpc", command)
    for command in ("", "run", "decode", "bench", "bench step", "paper", "sweep", "sweep merge", "falsify", "falsify merge", "catalogue", "report")
]
PAGES = {"lpvmpcd": "lpvmpcd.8", "lpvmpc-sim": "lpvmpc-sim.8", "lpvmpc": "lpvmpc.1"}


def sections(page):
    """The page's source by its headings."""
    return by_heading(SOURCE / f"docs/man/{page}.scd")


def by_heading(file):
    parts = re.split(r"^# (.*)\n", file.read_text(), flags=re.M)
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


def check_config(text):
    """What lpvmpcd says of a configuration file with this text; empty if it accepts it."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "daemon.toml"
        file.write_text(f'route.file = "{SOURCE / "scenarios/demo/route.toml"}"\n{text}\n')
        command = [PROGRAMS / "lpvmpcd", "--config", file, "--check-config"]
        outcome = subprocess.run(command, capture_output=True, text=True)
        return "" if outcome.returncode == 0 else outcome.stderr + outcome.stdout or "no word"


def configuration():
    """Default and allowed values of each key on the page, by table and name."""
    keys = {}
    for heading, text in by_heading(GENERATED / "lpvmpcd.toml.5.scd").items():
        for key, (default, body) in documented(text).items() if heading.startswith("[") else ():
            allowed = re.search(r" Allowed: (.*?)\.(?= Reloaded|$)", body.strip())
            keys[heading.strip("[]"), key] = (default.strip(" ="), allowed[1] if allowed else "")
    return keys


def beyond(allowed):
    """Values just outside the numbers that are allowed, if both ends are numbers."""
    limits = re.match(r"(?:each )?([-\w.]+?)\.\.([-\w.]+)", allowed)
    try:
        low, high = (float(limit) for limit in limits.groups())
    except (AttributeError, ValueError):
        return []
    whole = low.is_integer() and high.is_integer()
    return [f"{low - 1:.0f}", f"{high + 1:.0f}"] if whole else [repr(low - 1e-3), repr(high * 1.001)]


class ManPages(unittest.TestCase):
    def test_every_option_of_help_is_on_the_page_and_no_other(self):
        for program, command in COMMANDS:
            with self.subTest(program=program, command=command):
                text = help_of(program, command)
                listed = set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", text, flags=re.M)) - {"--help"}
                page = sections(PAGES[program])
                if command == "bench":
                    self.assertEqual(listed, set())
                    continue
                heading = {"lpvmpc": f"LPVMPC {command}".strip().upper()}.get(program, "OPTIONS")
                heading = "DESCRIPTION" if heading == "LPVMPC" else heading
                names = set(documented(page[heading])) - {"--help", "-h"}
                self.assertEqual({name for name in names if name.startswith("--")}, listed)

    def test_every_command_of_help_has_its_section(self):
        listed = re.findall(r"^  ([a-z]+) ", help_of("lpvmpc", "").split("Subcommands:")[1], flags=re.M)
        headings = [heading.split()[1].lower() for heading in sections("lpvmpc.1") if heading.startswith("LPVMPC ")]
        self.assertEqual(list(dict.fromkeys(headings)), listed)

    def test_every_default_on_the_page_is_accepted(self):
        keys = configuration()
        self.assertGreater(len(keys), 50)
        rules = {
            ("bus", "dbc"): f'"{SOURCE / "dbc/vehicle.dbc"}"',
            ("cycle", "deadline"): "0.05",
            ("cycle", "timeout"): "0.075",
            ("engage", "min_speed"): "0",
            ("controller", "P"): keys["controller", "Q"][0],
        }
        for (table, key), (default, _) in keys.items():
            if (table, key) == ("route", "file"):
                continue
            with self.subTest(table=table, key=key):
                self.assertEqual(check_config(f"{table}.{key} = {rules.get((table, key), default)}"), "")

    def test_values_beyond_the_ranges_on_the_page_are_refused(self):
        tried = 0
        for (table, key), (default, allowed) in configuration().items():
            for value in beyond(allowed):
                text = re.sub(r"[^][, ]+", value, default) if default.startswith("[") and default != "[]" else value
                if default == "[]":
                    text = f"[{value}]"
                if (table, key) == ("controller", "P"):
                    text = f"[{', '.join([value] * 6)}]"
                with self.subTest(table=table, key=key, value=text):
                    self.assertIn(f"{table}.{key}", check_config(f"{table}.{key} = {text}"))
                    tried += 1
        self.assertGreater(tried, 70)

    def test_choices_on_the_page_are_those_that_are_offered(self):
        for (table, key), (_, allowed) in configuration().items():
            if not allowed.startswith('"'):
                continue
            with self.subTest(table=table, key=key):
                refusal = check_config(f'{table}.{key} = "neither"')
                for choice in re.findall(r'"([^"]+)"', allowed):
                    self.assertIn(choice, refusal)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
