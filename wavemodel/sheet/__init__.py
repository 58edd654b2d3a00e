"""A sheet clamped round a hole: bending, shear, tension at finite deflection, and the elasticity of its edges."""
