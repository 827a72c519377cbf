"""Who asks for help: signs in pictures, buttons, keys, messages."""
