#!/usr/bin/env python3
"""Checks the includes and the link lines of lib/ and app/ against include_table.py: check_includes.py ROOT. Standard library only."""

import fnmatch
import pathlib
import re
import sys

import include_table

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)
COMMAND = re.compile(r"^[ \t]*(\w+)[ \t]*\(([^)]*)\)", re.MULTILINE)
SOURCES = (".hpp", ".cpp")


class Checker:
    """Problems of one tree, as `file:line: sentence`."""

    def __init__(self, root, table=include_table):
        self.root = pathlib.Path(root)
        self.table = table
        self.problems = []
        self.wrappers = {library["name"]: {} for library in table.LIBRARIES}

    def run(self):
        for top in ("lib", "app"):
            for path in sorted((self.root / top).rglob("*")):
                if path.suffix in SOURCES:
                    self.check_source(path)
                elif path.name == "CMakeLists.txt":
                    self.check_links(path)
        for library in self.table.LIBRARIES:
            self.check_wrappers(library)
        return self.problems

    def key(self, path):
        """`math/newton.hpp` for lib/math/newton.hpp, `app/main.cpp` for app/main.cpp."""
        relative = path.relative_to(self.root)
        return "/".join(relative.parts[1:] if relative.parts[0] == "lib" else relative.parts)

    def report(self, path, text, position, sentence):
        line = text.count("\n", 0, position) + 1
        self.problems.append(f"{path.relative_to(self.root)}:{line}: {sentence}")

    def allowed(self, key):
        folder = key.split("/")[0]
        patterns = [folder, "base"] + self.table.FOLDERS.get(folder, [])
        for file_pattern, more in self.table.FILES.items():
            if fnmatch.fnmatch(key, file_pattern):
                patterns += more
        return patterns

    def check_source(self, path):
        key = self.key(path)
        text = path.read_text(encoding="utf-8")
        if key.split("/")[0] not in self.table.FOLDERS:
            self.report(path, text, 0, f"folder {key.split('/')[0]} is not in the include table")
            return
        for match in INCLUDE.finditer(text):
            if match.group(1) == '"':
                self.check_own(path, key, text, match)
            else:
                self.check_library(path, key, text, match)

    def check_own(self, path, key, text, match):
        header = match.group(2)
        if header in self.table.GENERATED:
            return
        if not (self.root / "lib" / header).is_file() and not (self.root / header).is_file():
            self.report(path, text, match.start(), f'"{header}" is no file under lib/ (paths start there; libraries take <>)')
            return
        folder = header.split("/")[0]
        for pattern in self.allowed(key):
            if fnmatch.fnmatch(header, pattern) if "/" in pattern else folder == pattern:
                return
        self.report(path, text, match.start(), f'{key.split("/")[0]} may not include "{header}"')

    def check_library(self, path, key, text, match):
        header = match.group(2)
        if header in self.table.UNUSABLE:
            self.report(path, text, match.start(), f"<{header}> may not be used: {self.table.UNUSABLE[header]}")
            return
        if header in self.table.STANDARD:
            return
        # The last entry that knows the header is the most special one (Eigen's SuiteSparse modules).
        known = [library for library in self.table.LIBRARIES if re.match(library["headers"], header)]
        if not known:
            self.report(path, text, match.start(), f"<{header}> belongs to no library of the include table")
            return
        library = known[-1]
        folder = key.split("/")[0]
        if folder not in library["folders"] or not re.match(library.get("files", ""), key):
            self.report(path, text, match.start(), f"{key} may not include <{header}> of {library['name']}")
            return
        stem = key.rsplit(".", 1)[0]
        self.wrappers[library["name"]].setdefault(stem, (path, text, match.start()))

    def check_wrappers(self, library):
        stems = self.wrappers[library["name"]]
        if library["pairs"] is None or len(stems) <= library["pairs"]:
            return
        names = ", ".join(sorted(stems))
        for place in stems.values():
            self.report(*place, f"{library['name']} is wrapped by one file pair, but several include it: {names}")

    def check_links(self, path):
        """Link lines name the folders of the include table, and the libraries of the folder."""
        key = self.key(path)
        folder = key.split("/")[0]
        text = re.sub(r"#.*", lambda comment: " " * len(comment.group()), path.read_text(encoding="utf-8"))
        allowed = {pattern.split("/")[0] for pattern in self.allowed(key)}
        for file_pattern, more in self.table.FILES.items():
            allowed |= set(more) if file_pattern.startswith(folder + "/") else set()
        if "*" in allowed:
            allowed = set(self.table.FOLDERS) - {"app", "pipeline", "build"}
        for command in COMMAND.finditer(text):
            words = command.group(2).split()
            if command.group(1) == "target_link_libraries":
                links = words[1:]
            elif command.group(1) in ("muldi_library", "muldi_program") and "LINKS" in words:
                links = words[words.index("LINKS") + 1:]
            else:
                continue
            for target in links:
                self.check_target(path, text, command.start(), folder, allowed, target)

    def check_target(self, path, text, position, folder, allowed, target):
        if target in ("PUBLIC", "PRIVATE", "INTERFACE") or target in self.table.OWN_TARGETS:
            return
        if target.startswith("muldi_"):
            if target.removeprefix("muldi_").split("_")[0] not in allowed:
                self.report(path, text, position, f"{folder} may not link {target}")
            return
        for library in self.table.LIBRARIES:
            if re.fullmatch(library["targets"], target):
                if folder not in library["folders"]:
                    self.report(path, text, position, f"{folder} may not link {target} of {library['name']}")
                return
        self.report(path, text, position, f"{target} belongs to no library of the include table")


if __name__ == "__main__":
    found = Checker(sys.argv[1]).run()
    print("\n".join(found) if found else "the tree obeys the include table")
    sys.exit(1 if found else 0)
