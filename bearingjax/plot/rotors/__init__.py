"""Pictures of rotors."""
