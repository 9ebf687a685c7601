# SPDX-License-Identifier: Apache-2.0
"""words.py -- command lines of options that are mostly the same: no option stands twice."""


def unless_given(defaults, given):
    """The default words, each option with what follows it, but for options that are given."""
    words, keeps = [], True
    for word in map(str, defaults):
        if word.startswith("-") and not word[1:2].isdigit():
            keeps = word not in map(str, given)
        if keeps:
            words.append(word)
    return words
