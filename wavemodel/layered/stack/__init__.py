"""Through-thickness stiffness K(k), mass and creep of a stack of layers, whatever the domain."""
