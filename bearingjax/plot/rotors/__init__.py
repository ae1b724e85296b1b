"""Pictures of rotors, and of whole systems of shafts."""
