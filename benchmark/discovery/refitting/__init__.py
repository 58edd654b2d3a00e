"""Accepted effects in earnest: put into the FEM and the wave model, refitted there, and asked for unseen trials."""
