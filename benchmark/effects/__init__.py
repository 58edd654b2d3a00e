"""The catalogue of physical effects that a model can lack: one file an effect."""
