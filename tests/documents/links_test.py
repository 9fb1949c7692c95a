#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Every relative link of the Markdown documents leads to a file that is there, and to a heading of it.

    links_test.py PROJECT_FOLDER
"""
import re
import subprocess
import sys
import unittest
from pathlib import Path

PROJECT = Path(sys.argv.pop(1)).resolve()
LINK = re.compile(r"\]\(([^)\s]+)\)")


def text_of(path):
    """Without blocks and spans of code."""
    text = re.sub(r"^```.*?^```", "", path.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"`[^`\n]*`", "", text)


def anchors_of(path):
    """As GitHub makes them of headings."""
    text = re.sub(r"^```.*?^```", "", path.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    headings = re.findall(r"^#+ (.*)$", text, flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


class Links(unittest.TestCase):
    def test_lead_somewhere(self):
        listed = subprocess.run(["git", "ls-files", "*.md"], cwd=PROJECT, capture_output=True, text=True).stdout
        documents = [PROJECT / name for name in listed.split("\n") if name]
        documents = documents or [path for path in PROJECT.rglob("*.md") if "build" not in path.parts]
        self.assertGreater(len(documents), 10)
        links = 0
        for document in documents:
            for link in LINK.findall(text_of(document)):
                if re.match(r"[a-z]+:", link):
                    continue
                links += 1
                name, _, anchor = link.partition("#")
                target = (document.parent / name).resolve()
                with self.subTest(document=document.relative_to(PROJECT).as_posix(), link=link):
                    self.assertTrue(name, "expected the file before the heading: Doxygen finds none without it")
                    self.assertTrue(target.exists(), "no such file")
                    if anchor and target.suffix == ".md":
                        self.assertIn(anchor, anchors_of(target), "no such heading")
        self.assertGreater(links, 50)


if __name__ == "__main__":
    unittest.main()
