"""The program without a screen: profiles, store, worlds and robots, put together for games."""
