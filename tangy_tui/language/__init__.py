"""What words mean, typed or spoken: phrases, commands, stop, and how words are pronounced."""
