"""The addresses by which browsers and this machine's programs reach a page.

Apart from the server, so that a program that only asks for a page need not load it.
"""

from ipaddress import ip_address
from urllib.parse import quote

from sim_viewer.options import Options

ABOUT = "/about"  # the path at which a page says which one it is
EVERYWHERE = ("0.0.0.0", "::", "")  # all addresses of the machine


def page_url(options: Options, port: int) -> str:
    """The page's address for a browser on this machine."""
    return local_url(options.address, port) + _token(options)


def local_url(address: str, port: int) -> str:
    """The URL by which this machine reaches what listens at this address."""
    return _url("127.0.0.1" if address in EVERYWHERE else address, port)


def further_urls(options: Options, port: int, addresses: list[str]) -> list[str]:
    """The page's addresses for other machines, if it listens at all `addresses` of this one."""
    if options.address not in EVERYWHERE:
        return []
    return [_url(address, port) + _token(options) for address in addresses
            if not ip_address(address).is_loopback and not ip_address(address).is_link_local
            and (options.address != "0.0.0.0" or ":" not in address)]


def _url(host: str, port: int) -> str:
    return f"http://[{host}]:{port}/" if ":" in host else f"http://{host}:{port}/"


def _token(options: Options) -> str:
    return f"?token={quote(options.token)}" if options.token else ""
