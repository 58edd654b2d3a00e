"""The layered sheet over a hole in modes over the radius, at finite strain, without a plate theory."""
