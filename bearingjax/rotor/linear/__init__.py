"""Linear vibration of a rotor: modes, critical speeds, responses."""
