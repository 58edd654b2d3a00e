"""Domains: the in-plane eigenfunctions S with lap S = -k^2 S, their projection and synthesis."""
