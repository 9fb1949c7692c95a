# SPDX-License-Identifier: MIT
"""Finds races: words that one wave writes and another one reads or writes with nothing between that orders them.

Within a group barriers order waves, between groups nothing does. The lanes of a wave run in lockstep.
"""
import numpy as np

_SEVERAL = 0xffffffff  # waves, or groups


class Accesses:
    """Who last read and wrote each word of a buffer or of a group's local memory, and between which barriers.

    A wave is given by its number, its group's number (both from 1) and how many barriers it has passed (from 1).
    """

    def __init__(self, words):
        self.writer, self.writer_group, self.written = (np.zeros(words, np.uint32) for _ in range(3))
        self.reader, self.reader_group, self.read_at = (np.zeros(words, np.uint32) for _ in range(3))

    def _of_others(self, who, group, when, wave, words):
        """Whether an access by another wave is not ordered before this wave's present one."""
        others = (who[words] != 0) & (who[words] != wave.number)
        return others & ((group[words] != wave.group) | (when[words] == wave.barriers))

    def read(self, wave, words):
        """Whether any of the words is read while another wave writes it."""
        racing = self._of_others(self.writer, self.writer_group, self.written, wave, words)
        reader, group = self.reader[words], self.reader_group[words]
        outdated = (reader == 0) | (group == wave.group) & (self.read_at[words] < wave.barriers)
        self.reader[words] = np.where(outdated | (reader == wave.number), wave.number, _SEVERAL)
        self.reader_group[words] = np.where((reader == 0) | (group == wave.group), wave.group, _SEVERAL)
        self.read_at[words] = wave.barriers
        return bool(racing.any())

    def write(self, wave, words):
        """Whether any of the words is written while another wave reads or writes it."""
        racing = (self._of_others(self.writer, self.writer_group, self.written, wave, words) |
                  self._of_others(self.reader, self.reader_group, self.read_at, wave, words))
        self.writer[words], self.writer_group[words], self.written[words] = wave.number, wave.group, wave.barriers
        return bool(racing.any())
