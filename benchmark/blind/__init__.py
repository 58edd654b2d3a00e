"""Blind trials of the discovery: synthetic sessions with hidden effects, from a generator of its own.

The generator shares nothing with the discovery but the files of a session and the answer: its body is the
finite-strain FEM, its effects have other forms than those that are fitted. All sessions are synthetic and say so.
"""
