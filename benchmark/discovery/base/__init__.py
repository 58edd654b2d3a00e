"""The base of a discovery: its data as a problem, its model with effects, noise and priors, and the fits of both."""
