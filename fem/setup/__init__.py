"""From a problem to a model: mesh, contact, support, unknowns and equations."""
