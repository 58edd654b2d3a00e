"""Wave models of layered soft tissue."""
