"""Formats numbers and tables as Markdown."""


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(str(field) for field in row) + " |" for row in rows]
    return "\n".join(lines)


def command(*lines):
    """Formats the commands that produce the table above."""
    return "<!-- not run: the test of the evaluation runs it with --quick -->\n```sh\n" + "\n".join(lines) + "\n```"


def whole(number):
    """1234567 -> 1,234,567"""
    return f"{number:,}"


def percent(part, of, digits=1):
    return f"{100 * part / of:.{digits}f} %"


def decibel(error):
    """Formats the PSNR of a certificate, or says that there is no error."""
    if error["lossless"]:
        return "lossless"
    return "-" if error["psnr_db"] is None else f"{error['psnr_db']:.1f}"


def scientific(number):
    return "0" if number == 0 else f"{number:.2g}"
