# fish completion for relume: subcommands and options as --help lists them, else files.
function __relume_subcommands
    relume --help 2>/dev/null | sed -n '/^Subcommands/,$s/^  \([a-z][a-z]*\) .*/\1/p'
end
function __relume_options
    set -l words (commandline -opc)
    relume $words[2] --help 2>/dev/null | grep -oE '(^| |,)--[a-z][a-z-]*' | tr -d ' ,'
end
complete -c relume -n __fish_use_subcommand -f -a '(__relume_subcommands)'
complete -c relume -n 'string match -q -- "-*" (commandline -ct)' -f -a '(__relume_options)'
