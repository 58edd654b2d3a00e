"""Through-thickness stiffness K(k) and mass M of a stack of layers, whatever the domain."""
