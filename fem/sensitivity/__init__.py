"""Derivatives of converged steps by parameters of the problem, by direct differentiation."""
