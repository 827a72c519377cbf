"""`tangy serve`: watch a game in a browser."""

from __future__ import annotations

from typing import Annotated

import typer

from tangy_profiles.errors import TangyError
from tangy_tui.verbs.common import Data, print_line

PORT = 8770


def serve(
    host: Annotated[
        str, typer.Option(help="The address to listen at. Default: this machine's browsers only.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=1, max=65535, help="The port to listen at.")] = PORT,
    data: Data = None,
) -> None:
    """Show the game of another Tangy in a browser.

    It prints an address with a token, which is new each time. Nobody gets in without it.
    """
    from tangy_tui.app.serving import (
        EVERYWHERE,
        LOOPBACK,
        NoServer,
        address,
        command_line,
        make_server,
        new_token,
    )
    from tangy_tui.app.workspace import data_folder
    from tangy_tui.text import serving as text

    if host in EVERYWHERE:
        raise TangyError(text.GIVE_ADDRESS)
    token = new_token()
    folder = data_folder(data).absolute()
    command = command_line("watch", "--by", "a browser", "--data", str(folder))
    try:
        server = make_server(command, host, port, token)
    except NoServer:
        raise TangyError(text.NOT_INSTALLED) from None
    print_line(text.open_words(address(host, port, token)))
    print_line(text.WHO_MAY)
    if host != LOOPBACK:
        print_line(text.NOT_ENCRYPTED)
    try:
        server.serve()
    except OSError as error:
        raise TangyError(f"--port {port}: {error.strerror}.") from None
