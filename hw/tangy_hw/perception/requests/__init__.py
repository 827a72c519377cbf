"""Sources of requests for help: signs in images, buttons, keys, messages."""
