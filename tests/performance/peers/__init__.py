"""The same problems on the same meshes through this project's solver, FElupe and CalculiX."""
