"""Laws of materials: the energy of a strained place, its stress and its tangent."""
